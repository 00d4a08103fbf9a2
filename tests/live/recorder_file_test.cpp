// From a late joiner's events to a file: face and sound keep their distance in every container.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/media/media_support.h"
#include "tools/media/audio.h"
#include "tools/media/container.h"
#include "tools/media/live/loopback.h"
#include "tools/media/live/presentation.h"
#include "tools/media/live/recorder.h"
#include "tools/media/mux.h"

namespace animeme::media {
namespace recorder_file_test {

constexpr double kClick = 2.5;  // seconds of the presentation; plane 62 or so begins at 2.48

Pcm click(double length) {
  Pcm pcm{48000, std::vector<float>(std::size_t(length * 48000), 0.0F)};
  for (std::size_t i = 0; i < 240; ++i) {
    pcm.samples[std::size_t(kClick * 48000) + i] = float(0.8 * std::sin(double(i) * 0.5236));
  }
  return pcm;
}

double click_of(const Pcm& pcm) {
  for (std::size_t i = 0; i < pcm.samples.size(); ++i) {
    if (std::abs(pcm.samples[i]) > 0.3F) return double(i) / pcm.sample_rate;
  }
  return -1;
}

// What a receiver keeps that gets nothing before `face_from` and `sound_from`, seconds.
Recording record(const fba::AccessUnits& face, const EncodedAudio& sound, double face_from,
                 double sound_from) {
  ClipInput input(face, sound);
  Recorder recorder;
  (void)recorder.accept(input.info());
  const auto units = input.take(1e9);
  for (const LiveUnit& unit : *units) {
    const double from = unit.track == LiveTrack::face ? face_from : sound_from;
    if (seconds_of(input.info(), unit.track, unit.time) >= from) (void)recorder.accept(unit);
  }
  (void)recorder.accept(LiveEnd{});
  return recorder.recording();
}

struct Case {
  double face_from, sound_from;
  AudioCodec codec;
};

class LateJoiners : public testing::TestWithParam<Case> {};

TEST_P(LateJoiners, HearTheClickAtItsPlane) {
  const fba::AccessUnits face = test::make_face(125, 25000, 1000, 25);
  const auto sound = encode_audio(click(5), {GetParam().codec});
  ASSERT_TRUE(sound);
  const Recording recording = record(face, *sound, GetParam().face_from, GetParam().sound_from);
  const test::TempDir dir;
  for (const char* name : {"talk.mp4", "talk.mkv", "talk.ts"}) {
    const std::string path = dir.file(name);
    // Files of ours have no Opus in TS.
    const bool ts = std::string_view(name) == "talk.ts";
    if (ts && GetParam().codec == AudioCodec::opus) continue;
    MuxInput input{.face = &recording.face, .encoded = &recording.sound};
    const auto written = write_container(path, input);
    ASSERT_TRUE(written) << name << ": " << written.error().describe();
    const auto read = read_container(path);
    const auto pcm = read_audio(path);
    ASSERT_TRUE(read && pcm) << name;
    ASSERT_EQ(read->face.units.size(), recording.face.units.size()) << name;
    // The plane that begins at 2.48 s, found by its bytes.
    const auto& wanted = face.units[62].bytes;
    double plane = -1000;
    for (const fba::AccessUnit& unit : read->face.units) {
      if (unit.bytes == wanted) plane = double(unit.time) / read->face.timescale;
    }
    EXPECT_NEAR(click_of(*pcm) - plane, kClick - 2.48, 0.0016) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, LateJoiners,
    testing::Values(Case{-1, -1, AudioCodec::aac}, Case{1.5, 1.2, AudioCodec::aac},
                    Case{1.0, 1.7, AudioCodec::aac}, Case{-1, -1, AudioCodec::opus},
                    Case{1.5, 1.2, AudioCodec::opus}, Case{1.0, 1.7, AudioCodec::opus}));

}  // namespace recorder_file_test
}  // namespace animeme::media
