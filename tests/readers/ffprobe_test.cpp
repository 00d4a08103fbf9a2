// ffprobe: every packet of the face with its bytes, time and key flag, and the name of the profile.
#include "tests/readers/ffprobe.h"

namespace animeme::test {
namespace ffprobe_test {

class Ffprobe : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { NEEDS_PROGRAM("ffprobe", "ffmpeg"); }
};

TEST_P(Ffprobe, EveryUnitWithTimeAndKeyFlag) {
  const TempDir dir;
  const Layout layout = layout_of(GetParam());
  for (const Talk& talk : {walking_talk(), reference_talk("start_code_inside_face"),
                           reference_talk("skip_frames"), reference_talk("rate_29_97")}) {
    const std::string path = write_talk(dir, talk, layout);
    expect_packets(talk, layout, ask_ffprobe(path, layout, "-show_packets -show_data")["packets"]);
  }
}

TEST_P(Ffprobe, NamesTheProfile) {
  const TempDir dir;
  const Layout layout = layout_of(GetParam());
  const std::string path = write_talk(dir, walking_talk(), layout);
  const Json said = ask_ffprobe(path, layout, "-show_streams");
  ASSERT_EQ(said["streams"].size(), 1u);
  const Json& stream = said["streams"][0];
  if (layout.metadata()) {
    EXPECT_EQ(stream["codec_type"], "data");
    EXPECT_EQ(stream["codec_tag_string"], "mp4s");
    return;
  }
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

INSTANTIATE_TEST_SUITE_P(Layouts, Ffprobe, testing::ValuesIn(names_of(layouts())),
                         [](const auto& value) { return value.param; });

}  // namespace ffprobe_test
}  // namespace animeme::test
