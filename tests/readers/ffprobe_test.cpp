// ffprobe: every packet of the face with its bytes, time and key flag, and the name of the profile.
#include "tests/readers/readers_support.h"
#include "tests/readers/talk.h"

namespace animeme::test {
namespace {

class Ffprobe : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { NEEDS_PROGRAM("ffprobe", "ffmpeg"); }

  // In TS the parser for MPEG-4 video would glue the units (containers, section 2.3).
  static Json ask(const std::string& path, const std::string& options) {
    const std::string raw = path.ends_with(".ts") ? "-fflags noparse " : "";
    return run_json("ffprobe -v error " + raw + "-of json -select_streams v " + options + " '" +
                    path + "'");
  }

  static void expect_packets(const Talk& talk, const Layout& layout, const Json& packets) {
    const bool mp4 = layout.mp4();
    const std::vector<Bytes> units = units_of(talk, layout.ts());
    ASSERT_EQ(packets.size(), units.size());
    // mkv rounds the shift and each time to 1 ms.
    const double shift = double(layout.late()) / talk.sound.sample_rate;
    const double rounding = mp4 ? 1e-6 : layout.ts() ? 1.1 / 90000 : 0.001;
    for (std::size_t i = 0; i < units.size(); ++i) {
      const fba::AccessUnit& unit = talk.face.units[i];
      const Json& packet = packets[i];
      SCOPED_TRACE("unit " + std::to_string(i));
      EXPECT_EQ(to_hex(from_dump(packet["data"])), to_hex(units[i]));
      const double time = double(unit.time) / talk.face.timescale;
      EXPECT_NEAR(std::stod(packet["pts_time"].get<std::string>()), time + shift, rounding);
      if (mp4 && !layout.options.fragmented) {
        EXPECT_EQ(packet["duration"], unit.duration);
      }
      // PES packets have no key flag.
      if (!layout.ts()) {
        EXPECT_EQ(packet["flags"], unit.intra ? "K_" : "__");
      }
    }
  }
};

TEST_P(Ffprobe, EveryUnitWithTimeAndKeyFlag) {
  const TempDir dir;
  const Layout layout = layout_of(GetParam());
  for (const Talk& talk : {walking_talk(), reference_talk("start_code_inside_face"),
                           reference_talk("skip_frames"), reference_talk("rate_29_97")}) {
    const std::string path = write_talk(dir, talk, layout);
    expect_packets(talk, layout, ask(path, "-show_packets -show_data")["packets"]);
  }
}

TEST_P(Ffprobe, NamesTheProfile) {
  const TempDir dir;
  const Layout layout = layout_of(GetParam());
  const std::string path = write_talk(dir, walking_talk(), layout);
  const Json said = ask(path, "-show_streams");
  ASSERT_EQ(said["streams"].size(), 1u);
  const Json& stream = said["streams"][0];
  EXPECT_EQ(stream["codec_name"], "mpeg4");
  EXPECT_EQ(stream["profile"], "Simple Face Animation Profile");
  if (layout.mp4()) {
    EXPECT_EQ(stream["codec_tag_string"], "mp4v");
  }
  if (layout.ts()) {
    EXPECT_EQ(stream["codec_tag"], "0x0010") << "stream type";
  }
  if (!layout.ts()) {
    EXPECT_EQ(stream["r_frame_rate"], "25/1");
  }
}

INSTANTIATE_TEST_SUITE_P(Layouts, Ffprobe, testing::ValuesIn(layout_names()),
                         [](const auto& value) { return value.param; });

}  // namespace
}  // namespace animeme::test
