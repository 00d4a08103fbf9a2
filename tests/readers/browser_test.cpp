// Chromium: the sound decoded by WebAudio with the bursts in place, an <audio> element that plays,
// and the units of the face by mp4box in the page (tools/formats/media/containers.md, section 4.4).
// One test, since starting a browser takes longer than all of its checks.
#include "tests/readers/scripts.h"
#include "tests/readers/talk.h"

namespace animeme::test {
namespace browser_test {

// Chromium cuts the priming of Opus off twice where an edit list tells it, too (of any writer's
// files, Ogg included); without, as in fragments, it is right.
std::vector<std::int64_t> delays_of(const Layout& layout) {
  if (layout.name == "mp4_opus" || layout.name == "opus") return {0, -layout.priming()};
  return {layout.late()};
}

void expect_decoded(const Json& decoded, const std::string& path, const Talk& talk,
                    const Layout& layout) {
  ASSERT_TRUE(decoded.contains("length")) << decoded;
  // Only an edit list can tell where the last frame ends.
  const auto length = std::int64_t(talk.sound.samples.size());
  EXPECT_NEAR(decoded["length"], double(length + layout.late()), layout.name == "mp4" ? 0 : 2048);
  const media::Pcm heard = read_floats(path + ".f32", decoded["rate"]);
  const double rounding = layout.extension == ".mkv" || layout.extension == ".webm" ? 48
                          : layout.opus()                                           ? 3
                                                                                    : 1;
  for (const std::int64_t click : talk.clicks) {
    const std::int64_t found = find_click(heard, click, 3000);
    double error = 1e9;
    for (const std::int64_t delay : delays_of(layout)) {
      error = std::min(error, std::abs(double(found - click - delay)));
    }
    EXPECT_LE(error, rounding) << "burst at " << click << " heard at " << found;
  }
}

void expect_played(const Json& played, const Talk& talk, const Layout& layout) {
  ASSERT_TRUE(played["error"].is_null()) << played;
  EXPECT_GE(played["heard"], 1.0);
  EXPECT_EQ(played["ascending"], true);
  EXPECT_GT(played["steps"], 10);
  const double seconds =
      double(std::int64_t(talk.sound.samples.size()) + layout.late()) / talk.sound.sample_rate;
  EXPECT_NEAR(played["duration"], seconds, 0.03);
}

// Presentations in segments, AAC and Opus; their names.
std::vector<std::string> write_playlists(const TempDir& dir, const Talk& talk) {
  std::vector<std::string> names;
  for (const Layout& layout : segment_layouts()) {
    names.push_back(fs::path(write_talk(dir, talk, layout)).filename().string());
  }
  return names;
}

void expect_streamed(const Json& played, const Talk& talk, const Layout& layout) {
  ASSERT_TRUE(played["error"].is_null()) << played;
  EXPECT_GE(played["heard"], 1.0);
  EXPECT_EQ(played["ascending"], true);
  // The player takes the sound and leaves the face alone.
  EXPECT_EQ(played["tracks"], Json::array({layout.opus() ? "opus" : "mp4a.40.2"}));
  EXPECT_NEAR(played["duration"], talk.sound.duration(), 0.03);
}

TEST(Browser, PlaysTheSoundAndReadsTheFace) {
  NEEDS_PROGRAM("chromium", "chromium");
  NEEDS_NPM("mp4box");
  NEEDS_NPM("shaka-player");
  const TempDir dir;
  const Talk talk = walking_talk();
  std::string names;
  std::vector<Layout> all = layouts();
  for (const Layout& layout : sound_layouts()) all.push_back(layout);
  for (const Layout& layout : all) {
    // No browser reads one, and this one plays the frames of sound that share a packet as raw AAC
    // without an end.
    if (layout.ts()) continue;
    names += " " + fs::path(write_talk(dir, talk, layout)).filename().string();
  }
  for (const std::string& name : write_playlists(dir, talk)) names += " " + name;
  const Json report = run_script("browser_report.js", "'" + dir.file("") + "'" + names);
  ASSERT_TRUE(report.contains("files"));
  EXPECT_EQ(report["messages"], Json::array()) << "the console of the page";
  for (const Layout& layout : segment_layouts()) {
    SCOPED_TRACE(layout.name);
    expect_streamed(report["files"][layout.name + layout.extension]["played"], talk, layout);
  }
  for (const Layout& layout : all) {
    SCOPED_TRACE(layout.name);
    const std::string path = dir.file(layout.name + layout.extension);
    const Json& said = report["files"][layout.name + layout.extension];
    if (layout.ts()) continue;
    expect_decoded(said["decoded"], path, talk, layout);
    expect_played(said["played"], talk, layout);
    if (!layout.mp4()) continue;
    // script_test.cpp compares what node says with the talk, sample for sample.
    EXPECT_EQ(said["mp4box"], run_script("report.js", "mp4box '" + path + "'"));
  }
}

}  // namespace browser_test
}  // namespace animeme::test
