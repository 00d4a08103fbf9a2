#include "tools/formats/media/live/live_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec/decode/fill.h"
#include "codec/encode/live.h"
#include "fap/text.h"
#include "tests/support/random_clip.h"

namespace animeme::media {
namespace live_frames_test {

struct Coded {
  std::vector<LiveUnit> units;
  std::vector<std::uint8_t> stream;
};

// Planes of a clip as a live encoder codes them, 90000 ticks a second.
Coded code(const fap::Sequence& clip, int intra_period = 10) {
  fba::LiveOptions options;
  options.rate = clip.rate;
  options.intra_seconds = intra_period / 25.0;
  fap::Mask mask;
  for (const fap::Frame& frame : clip.frames) mask |= frame.mask;
  options.faps = mask;
  fba::LiveEncoder encoder(options);
  Coded coded;
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    const bool last = i + 1 == clip.frames.size();
    const std::int64_t next = last ? clip.frames[i].number + 1 : clip.frames[i + 1].number;
    auto bytes = encoder.write(clip.frames[i], std::uint32_t(next - clip.frames[i].number - 1));
    EXPECT_TRUE(bytes) << bytes.error().describe();
    coded.stream.insert(coded.stream.end(), bytes->begin(), bytes->end());
    const double seconds = clip.rate.seconds(double(clip.frames[i].number));
    coded.units.push_back(
        {LiveTrack::face, std::move(*bytes), encoder.intra(), std::llround(seconds * 90000), 1});
  }
  const auto end = encoder.finish();
  coded.stream.insert(coded.stream.end(), end.begin(), end.end());
  return coded;
}

std::vector<fap::Frame> push_all(LiveFrames& frames, const std::vector<LiveUnit>& units) {
  std::vector<fap::Frame> all;
  for (const LiveUnit& unit : units) {
    const auto some = frames.push(unit, 90000, false);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

TEST(LiveFrames, AreThoseOfTheWholeStreamOneByOne) {
  for (int seed = 1; seed <= 6; ++seed) {
    const Coded coded = code(test::random_clip(seed, 60, true));
    const auto decoded = fba::decode(coded.stream);
    ASSERT_TRUE(decoded);
    LiveFrames frames(GapRule::hold, std::nullopt);
    EXPECT_EQ(push_all(frames, coded.units), fba::face_sequence(*decoded).frames) << seed;
    EXPECT_EQ(frames.rate(), decoded->rate);
  }
}

TEST(LiveFrames, FilledOnesAreThoseOfTheFilledStream) {
  for (int seed = 1; seed <= 6; ++seed) {
    const Coded coded = code(test::random_clip(seed, 60));
    const auto decoded = fba::decode(coded.stream);
    ASSERT_TRUE(decoded);
    const auto filled = fba::fill(*decoded, {.complete = true});
    ASSERT_TRUE(filled);
    LiveFrames frames(GapRule::hold, fap::FillOptions{.complete = true});
    const auto live = push_all(frames, coded.units);
    ASSERT_EQ(live.size(), filled->frames.size());
    for (std::size_t i = 0; i < live.size(); ++i) {
      ASSERT_EQ(live[i].value, filled->frames[i].value) << seed << " " << i;
      ASSERT_EQ(live[i].mask, filled->frames[i].mask) << seed << " " << i;
    }
  }
}

fap::Sequence ramp(int frames) {
  fap::Sequence clip;
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(3, 100 + 4 * i);  // FAP 3 has steps of 4
    clip.frames.push_back(frame);
  }
  return clip;
}

// Planes 15 to 19 of 30 are missing; 20 is intra.
std::vector<fap::Frame> with_gap(GapRule rule) {
  const Coded coded = code(ramp(30));
  LiveFrames frames(rule, std::nullopt);
  std::vector<fap::Frame> all;
  for (std::size_t i = 0; i < 30; ++i) {
    if (i >= 15 && i < 20) continue;
    const auto some = frames.push(coded.units[i], 90000, i == 20);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

TEST(LiveFrames, AGapHoldsTheLastValues) {
  const auto frames = with_gap(GapRule::hold);
  ASSERT_EQ(frames.size(), 30u);
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(frames[std::size_t(i)].number, i);
    EXPECT_EQ(frames[std::size_t(i)].value[3], i >= 15 && i < 20 ? 156 : 100 + 4 * i);
  }
}

TEST(LiveFrames, AGapEasesToNeutral) {
  const auto frames = with_gap(GapRule::neutral);
  ASSERT_EQ(frames.size(), 30u);
  // 0.4 s are ten frames: a tenth of the way each.
  for (int i = 15; i < 20; ++i) {
    EXPECT_NEAR(frames[std::size_t(i)].value[3], 156 * (1 - (i - 14) / 10.0), 0.51) << i;
  }
  EXPECT_EQ(frames[20].value[3], 180);
}

TEST(LiveFrames, AGapIsSkippedOnRequest) {
  const auto frames = with_gap(GapRule::skip);
  ASSERT_EQ(frames.size(), 25u);
  EXPECT_EQ(frames[14].number, 14);
  EXPECT_EQ(frames[15].number, 20);
}

TEST(LiveFrames, JoiningInTheMiddleBeginsAtNumber0) {
  const Coded coded = code(ramp(30));
  LiveFrames frames(GapRule::hold, std::nullopt);
  const auto all = push_all(frames, {coded.units.begin() + 10, coded.units.end()});
  ASSERT_EQ(all.size(), 20u);
  EXPECT_EQ(all[0].number, 0);
  EXPECT_EQ(all[0].value[3], 140);
}

TEST(LiveFrames, ADamagedPlaneIsAGapUpToTheNextIntraPlane) {
  const Coded coded = code(ramp(30));
  LiveFrames frames(GapRule::hold, std::nullopt);
  std::vector<fap::Frame> all;
  for (std::size_t i = 0; i < 30; ++i) {
    LiveUnit unit = coded.units[i];
    if (i == 12) unit.bytes.resize(5);  // start code and a byte
    const auto some = frames.push(unit, 90000, false);
    all.insert(all.end(), some.begin(), some.end());
  }
  ASSERT_EQ(all.size(), 30u);
  EXPECT_EQ(all[11].value[3], 144);
  for (std::size_t i = 20; i < 30; ++i) EXPECT_EQ(all[i].value[3], 100 + 4 * int(i));
}

// The sender leaves frames out and sides to be mirrored; players want all of it.
TEST(LiveFrames, ShownOnesHaveNoGapsAndBothSides) {
  fap::Sequence clip = ramp(30);
  for (fap::Frame& frame : clip.frames) frame.set(19, 100);
  clip.frames.erase(clip.frames.begin() + 7, clip.frames.begin() + 9);
  const Coded coded = code(clip);
  LiveFrames frames(GapRule::neutral, fap::FillOptions{.keep_high_level = true});
  const auto all = push_all(frames, coded.units);
  ASSERT_EQ(all.size(), 30u);
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(all[std::size_t(i)].number, i);
    EXPECT_EQ(all[std::size_t(i)].value[3], i == 7 || i == 8 ? 124 : 100 + 4 * i) << i;
  }
}

}  // namespace live_frames_test
}  // namespace animeme::media
