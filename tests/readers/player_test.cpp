// Players: the sound of every layout, its length, and the bursts in their places
// (tools/formats/media/containers.md, section 5.3).
#include "tests/readers/readers_support.h"
#include "tests/readers/talk.h"

namespace animeme::test {
namespace player_test {

class Player : public testing::TestWithParam<std::string> {
 protected:
  // `command` plays `path_` into the file `raw_`, as 32-bit floats of one channel.
  void expect_sound(const std::string& command, std::int64_t delay) const {
    int status = 0;
    const std::string said = run(command + " 2>&1", &status);
    ASSERT_EQ(status, 0) << command << "\n" << said;
    const media::Pcm heard = read_floats(raw_, talk_.sound.sample_rate);
    // The last frame is whole, but some players leave it to the decoder.
    const auto length = std::int64_t(talk_.sound.samples.size()) + delay;
    EXPECT_GT(std::int64_t(heard.samples.size()), length - 1024);
    EXPECT_LT(std::int64_t(heard.samples.size()), length + 2 * 1024);
    expect_bursts(heard, talk_, delay, layout_.opus() ? 3 : 1);
  }

  TempDir dir_;
  Talk talk_ = walking_talk();
  Layout layout_ = layout_of(GetParam());
  std::string path_ = write_talk(dir_, talk_, layout_);
  std::string raw_ = dir_.file("heard.f32");
};

TEST_P(Player, Ffmpeg) {
  NEEDS_PROGRAM("ffmpeg", "ffmpeg");
  // In fragments it knows of the priming of AAC by the times only, and raw samples have none.
  const bool keeps_priming = layout_.options.fragmented && !layout_.opus();
  expect_sound("ffmpeg -nostdin -v fatal -i '" + path_ + "' -vn -f f32le '" + raw_ + "'",
               keeps_priming ? layout_.priming() : layout_.late());
}

TEST_P(Player, Mpv) {
  NEEDS_PROGRAM("mpv", "mpv");
  expect_sound(
      "mpv --no-config --no-video --really-quiet --audio-format=float --ao=pcm "
      "--ao-pcm-waveheader=no --ao-pcm-file='" +
          raw_ + "' '" + path_ + "'",
      layout_.late());
}

INSTANTIATE_TEST_SUITE_P(Layouts, Player, testing::ValuesIn(names_of(layouts())),
                         [](const auto& value) { return value.param; });
INSTANTIATE_TEST_SUITE_P(SoundAlone, Player, testing::ValuesIn(names_of(sound_layouts())),
                         [](const auto& value) { return value.param; });

// GStreamer's player plays sound alone and beside a face that is metadata, but fails on one that is
// video.
// With the decoder faad, AAC of whatever writer comes a frame early.
class SoundPlayer : public Player {};

TEST_P(SoundPlayer, Playbin) {
  NEEDS_PROGRAM("gst-launch-1.0", "gstreamer1.0-tools");
  const bool faad = !layout_.opus() && std::system("gst-inspect-1.0 --exists faad") == 0 &&
                    std::system("gst-inspect-1.0 --exists avdec_aac") != 0;
  const std::string sink =
      "audioconvert ! audio/x-raw,format=F32LE,channels=1 ! filesink location=" + raw_;
  expect_sound(
      "timeout 60 gst-launch-1.0 -q playbin uri='file://" + path_ + "' audio-sink='" + sink + "'",
      layout_.late() - (faad ? 1024 : 0));
}

INSTANTIATE_TEST_SUITE_P(BesideAFace, SoundPlayer, testing::Values("mp4", "mp4_opus"),
                         [](const auto& value) { return std::string(value.param); });
INSTANTIATE_TEST_SUITE_P(SoundAlone, SoundPlayer, testing::ValuesIn(names_of(sound_layouts())),
                         [](const auto& value) { return value.param; });

}  // namespace player_test
}  // namespace animeme::test
