// Chromium: the sound decoded by WebAudio with the bursts in place, an <audio> element that plays,
// and the units of the face by mp4box in the page (containers, section 4.4). One test, since
// starting a browser takes longer than all of its checks.
#include "tests/readers/scripts.h"
#include "tests/readers/talk.h"

namespace animeme::test {
namespace {

void expect_decoded(const Json& decoded, const std::string& path, const Talk& talk,
                    std::int64_t delay) {
  ASSERT_TRUE(decoded.contains("length")) << decoded;
  const auto length = std::int64_t(talk.sound.samples.size()) + delay;
  // Only an edit list can tell where the last frame of AAC ends.
  EXPECT_GE(decoded["length"], length);
  EXPECT_LE(decoded["length"], delay == 0 ? length : length + 2048);
  const media::Pcm heard = read_floats(path + ".f32", decoded["rate"]);
  for (const std::int64_t click : talk.clicks) {
    EXPECT_NEAR(double(find_click(heard, click + delay, 3000)), double(click + delay), 1.0);
  }
}

void expect_played(const Json& played, const Talk& talk, std::int64_t delay) {
  ASSERT_TRUE(played["error"].is_null()) << played;
  EXPECT_GE(played["heard"], 1.0);
  EXPECT_EQ(played["ascending"], true);
  EXPECT_GT(played["steps"], 10);
  const double seconds =
      double(std::int64_t(talk.sound.samples.size()) + delay) / talk.sound.sample_rate;
  EXPECT_NEAR(played["duration"], seconds, 0.03);
}

TEST(Browser, PlaysTheSoundAndReadsTheFace) {
  NEEDS_PROGRAM("chromium", "chromium");
  NEEDS_NPM("mp4box");
  const TempDir dir;
  const Talk talk = walking_talk();
  std::string names;
  for (const Layout& layout : layouts()) {
    names += " " + fs::path(write_talk(dir, talk, layout)).filename().string();
  }
  const Json report = run_script("browser_report.js", "'" + dir.file("") + "'" + names);
  ASSERT_TRUE(report.contains("files"));
  EXPECT_EQ(report["messages"], Json::array()) << "the console of the page";
  for (const Layout& layout : layouts()) {
    SCOPED_TRACE(layout.name);
    const std::string path = dir.file(layout.name + layout.extension);
    const Json& said = report["files"][layout.name + layout.extension];
    if (layout.extension == ".ts") continue;  // no browser reads one by itself
    const std::int64_t delay = layout.extension == ".mkv" ? 1024 : 0;
    expect_decoded(said["decoded"], path, talk, delay);
    expect_played(said["played"], talk, delay);
    if (layout.extension != ".mp4") continue;
    // script_test.cpp compares what node says with the talk, sample for sample.
    EXPECT_EQ(said["mp4box"], run_script("report.js", "mp4box '" + path + "'"));
  }
}

}  // namespace
}  // namespace animeme::test
