// LiveEncoder: one frame in, one unit out.
#include "codec/encode/live.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "fap/tables.h"
#include "tests/support/random_clip.h"

namespace animeme {
namespace live_test {

struct Sent {
  std::vector<std::vector<std::uint8_t>> units;
  std::vector<bool> intra;
  std::vector<fap::Frame> frames;
};

Sent send(const fap::Sequence& clip, const fba::LiveOptions& options) {
  Sent sent;
  fba::LiveEncoder encoder(options);
  for (const fap::Frame& frame : clip.frames) {
    auto unit = encoder.write(frame);
    EXPECT_TRUE(unit) << unit.error().describe();
    if (!unit) return sent;
    sent.units.push_back(*unit);
    sent.intra.push_back(encoder.intra());
    sent.frames.push_back(encoder.reconstruction());
  }
  sent.units.push_back(encoder.finish());
  return sent;
}

std::vector<std::uint8_t> join(const Sent& sent, std::size_t from) {
  std::vector<std::uint8_t> stream;
  for (std::size_t i = from; i < sent.units.size(); ++i) {
    stream.insert(stream.end(), sent.units[i].begin(), sent.units[i].end());
  }
  return stream;
}

void expect_decodes(const Sent& sent, std::size_t from) {
  auto decoded = fba::decode(join(sent, from));
  ASSERT_TRUE(decoded) << decoded.error().describe();
  ASSERT_EQ(decoded->planes.size(), sent.frames.size() - from);
  for (std::size_t i = 0; i < decoded->planes.size(); ++i) {
    ASSERT_EQ(decoded->planes[i].face.value, sent.frames[from + i].value) << "unit " << from + i;
    ASSERT_EQ(decoded->planes[i].face.mask, sent.frames[from + i].mask);
  }
  EXPECT_EQ(decoded->rate, (fap::Rate{25, 1}));
}

fap::Sequence calm_clip(int frames) {
  test::Random random(9);
  fap::Sequence clip;
  fap::Frame frame;
  for (int i = 0; i < frames; ++i) {
    frame.number = i;
    for (const int fap : {3, 4, 5, 48}) {
      frame.set(fap, frame.value[std::size_t(fap)] + random.range(-30, 30));
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

class Live : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Live, ReceiversCanJoinAtEveryIntraPlane) {
  const fap::Sequence clip = test::random_clip(GetParam(), 60);
  fba::LiveOptions options;
  options.fap_quant = 1 + int(GetParam() % 4);
  options.intra_seconds = 12 / 25.0;
  const Sent sent = send(clip, options);
  ASSERT_EQ(sent.frames.size(), clip.frames.size());
  int joined = 0;
  for (std::size_t i = 0; i < sent.intra.size(); ++i) {
    if (!sent.intra[i]) continue;
    expect_decodes(sent, i);
    ++joined;
  }
  EXPECT_GE(joined, 5);
}

TEST_P(Live, ValuesAreWithinHalfAStep) {
  const fap::Sequence clip = test::random_clip(GetParam(), 40);
  const Sent sent = send(clip, {});
  ASSERT_EQ(sent.frames.size(), clip.frames.size());
  fap::Frame held;
  for (std::size_t i = 0; i < sent.frames.size(); ++i) {
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (clip.frames[i].mask[fap]) held.value[fap] = clip.frames[i].value[fap];
      if (!sent.frames[i].mask[fap]) continue;
      EXPECT_LE(std::abs(held.value[fap] - sent.frames[i].value[fap]),
                fap::info(int(fap)).quant_step / 2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Live, testing::Range<std::uint64_t>(1, 9));

TEST(LiveEncoder, IntraPlanesComeInTime) {
  const Sent sent = send(calm_clip(101), {.intra_seconds = 25 / 25.0});
  for (std::size_t i = 0; i < sent.intra.size(); ++i) EXPECT_EQ(sent.intra[i], i % 25 == 0) << i;
}

TEST(LiveEncoder, RangesAdaptToTheMotion) {
  const fap::Sequence clip = calm_clip(200);
  const Sent sent = send(clip, {.intra_seconds = 50 / 25.0});
  auto decoded = fba::decode(join(sent, 0));
  ASSERT_TRUE(decoded);
  const auto range = [&](std::size_t plane) {
    return int(decoded->planes[plane].face_settings->range[fba::kPredictiveMax][4]);
  };
  EXPECT_GT(range(0), range(150));
  EXPECT_EQ(range(150), 1);
}

TEST(LiveEncoder, ALargeChangeBringsAnIntraPlane) {
  fap::Sequence clip = calm_clip(120);
  clip.frames[110].value[5] = 3000;
  const Sent sent = send(clip, {.intra_seconds = 0});
  EXPECT_TRUE(sent.intra[110]);
  EXPECT_FALSE(sent.intra[109]);
  expect_decodes(sent, 0);
  expect_decodes(sent, 110);
}

TEST(LiveEncoder, ANewFapBringsAnIntraPlane) {
  fap::Sequence clip = calm_clip(30);
  for (std::size_t i = 20; i < 30; ++i) clip.frames[i].set(31, 40);
  const Sent sent = send(clip, {.intra_seconds = 0});
  EXPECT_TRUE(sent.intra[20]);
  EXPECT_EQ(sent.frames[25].value[31], 40);
  expect_decodes(sent, 0);

  const Sent fixed = send(clip, {.intra_seconds = 0, .faps = fap::Mask().set(3).set(4)});
  EXPECT_FALSE(fixed.intra[20]);
  EXPECT_EQ(fixed.frames[25].mask, fap::Mask().set(3).set(4));
}

// Lids, brows and gaze that move alike up to frame 60, then one brow alone; lips never follow.
fap::Sequence mirrored_clip(int frames) {
  test::Random random(4);
  fap::Sequence clip;
  fap::Frame frame;
  for (int i = 0; i < frames; ++i) {
    frame.number = i;
    for (const int fap : {3, 8, 19, 21, 25, 31, 61}) {
      const int value = frame.value[std::size_t(fap)] + random.range(-40, 40);
      frame.set(fap, value);
      if (const int other = fap::info(fap).mirror; other != 0) frame.set(other, value);
    }
    frame.set(23, random.range(-9000, 9000));
    frame.set(24, random.range(-9000, 9000));
    if (i >= 60) frame.set(32, frame.value[31] + 50);
    clip.frames.push_back(frame);
  }
  return clip;
}

TEST(LiveEncoder, MirrorsWhatIsEqualAsLongAsItIs) {
  const fap::Sequence clip = mirrored_clip(120);
  fba::LiveOptions options{.intra_seconds = 1};
  const Sent both = send(clip, options);
  options.mirror = true;
  const Sent sent = send(clip, options);
  expect_decodes(sent, 0);
  EXPECT_FALSE(sent.frames[59].mask[32]);
  EXPECT_TRUE(sent.frames[60].mask[32]);
  EXPECT_TRUE(sent.intra[60]);
  for (const std::size_t fap : {9, 24}) EXPECT_TRUE(sent.frames[119].mask[fap]) << fap;
  for (const std::size_t fap : {20, 22, 26, 62}) EXPECT_FALSE(sent.frames[119].mask[fap]) << fap;
  EXPECT_LT(join(sent, 0).size(), join(both, 0).size() * 9 / 10);
  // Receivers that join at any intra plane show what others would.
  for (std::size_t from = 0; from < sent.frames.size(); ++from) {
    if (!sent.intra[from]) continue;
    const auto decoded = fba::decode(join(sent, from));
    ASSERT_TRUE(decoded);
    const auto shown = fba::fill(*decoded);
    ASSERT_TRUE(shown);
    for (std::size_t i = 0; i < shown->frames.size(); ++i) {
      for (const auto& [fap, other] : {std::pair(20, 19), {22, 21}, {26, 25}, {62, 61}}) {
        EXPECT_EQ(shown->frames[i].value[std::size_t(fap)],
                  sent.frames[from + i].value[std::size_t(other)]);
      }
      const std::size_t brow = from + i < 60 ? 31 : 32;
      EXPECT_EQ(shown->frames[i].value[32], sent.frames[from + i].value[brow]);
    }
  }
}

// FAP 36 never occurs: mirrored, it would move.
TEST(LiveEncoder, NothingIsMirroredThatNobodyGave) {
  fap::Sequence clip = mirrored_clip(30);
  for (fap::Frame& frame : clip.frames) frame.set(35, int(frame.number) * 10);
  fba::LiveOptions options;
  options.mirror = true;
  const Sent sent = send(clip, options);
  EXPECT_TRUE(sent.frames[20].mask[32]);
  EXPECT_FALSE(sent.frames[20].mask[20]);
  const auto shown = fba::fill(*fba::decode(join(sent, 0)));
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->frames[20].value[36], 0);
}

TEST(LiveEncoder, GivenRangesAreUsed) {
  fba::PredictiveRanges ranges{};
  ranges.fill(3);
  const Sent sent = send(calm_clip(60), {.intra_seconds = 20 / 25.0, .ranges = ranges});
  auto decoded = fba::decode(join(sent, 0));
  ASSERT_TRUE(decoded);
  for (const fba::Plane& plane : decoded->planes) {
    EXPECT_EQ(plane.face_settings->range[fba::kPredictiveMax][4], 3);
    EXPECT_EQ(plane.face_settings->range[fba::kPredictiveMin][4], 3);
  }
}

TEST(LiveEncoder, LargerChangesWidenTheRangesThatWereGiven) {
  fba::PredictiveRanges ranges{};
  ranges.fill(1);
  fap::Sequence clip = calm_clip(60);
  clip.frames[30].value[4] = clip.frames[29].value[4] + 200 * fap::info(4).quant_step;
  const Sent sent = send(clip, {.intra_seconds = 1, .ranges = ranges});
  EXPECT_TRUE(sent.intra[30]);
  auto decoded = fba::decode(join(sent, 0));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->planes[29].face_settings->range[fba::kPredictiveMax][4], 1);
  EXPECT_EQ(decoded->planes[59].face_settings->range[fba::kPredictiveMax][4], 4);
}

TEST(LiveEncoder, RangesOfAClipHoldIt) {
  const fap::Sequence clip = calm_clip(200);
  for (const int quant : {1, 2, 5, 31}) {
    const Sent sent =
        send(clip, {.fap_quant = quant, .intra_seconds = 0, .ranges = fba::ranges_of(clip, quant)});
    // One more where the bits of a plane held a hazard.
    EXPECT_LE(std::count(sent.intra.begin(), sent.intra.end(), true), 2) << quant;
  }
}

TEST(LiveEncoder, PeriodsAreSecondsAtAnyRate) {
  for (const fap::Rate rate : {fap::Rate{25, 1}, fap::Rate{60, 1}, fap::Rate{30000, 1001}}) {
    fba::LiveEncoder encoder({.rate = rate, .intra_seconds = 2});
    const int period = int(std::lround(2 * rate.frames_per_second()));
    const fap::Sequence clip = calm_clip(3 * period);
    int early = 0;  // where the bits of a plane held a hazard
    int since = 0;
    for (int i = 0; i < 3 * period; ++i, ++since) {
      ASSERT_TRUE(encoder.write(clip.frames[std::size_t(i)]));
      EXPECT_TRUE(since < period || encoder.intra()) << i;
      if (!encoder.intra()) continue;
      early += since % period != 0 ? 1 : 0;
      since = 0;
    }
    EXPECT_LE(early, 1);
  }
}

// Frames that are skipped take time, too.
TEST(LiveEncoder, SkippedFramesCount) {
  fba::LiveEncoder encoder({.intra_seconds = 1});
  const fap::Sequence clip = calm_clip(30);
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(encoder.write(clip.frames[std::size_t(i)], 4));
    EXPECT_EQ(encoder.intra(), i % 5 == 0) << i;
  }
}

// A value beyond what an intra plane holds is followed as far as planes reach.
TEST(LiveEncoder, ValuesBeyondTheLimitAreFollowed) {
  fap::Sequence clip = calm_clip(30);
  for (std::size_t i = 0; i < 30; ++i) clip.frames[i].set(14, i < 10 ? 0 : 2500);
  const Sent sent = send(clip, {.intra_seconds = 0});
  ASSERT_EQ(sent.frames.size(), 30U);
  EXPECT_TRUE(sent.intra[10]);
  EXPECT_EQ(sent.frames[10].value[14], 1860);
  EXPECT_EQ(sent.frames[12].value[14], 2500);
  expect_decodes(sent, 0);
}

TEST(LiveEncoder, WithoutStartCodesPlanesFollowBitByBit) {
  const fap::Sequence clip = calm_clip(60);
  const Sent all = send(clip, {.intra_seconds = 1});
  const Sent some =
      send(clip, {.intra_seconds = 1, .plane_start_codes = fba::PlaneStartCodes::intra});
  const Sent none =
      send(clip, {.intra_seconds = 1, .plane_start_codes = fba::PlaneStartCodes::none});
  expect_decodes(some, 0);
  expect_decodes(none, 0);
  EXPECT_LT(join(some, 0).size() + 57 * 4, join(all, 0).size());
  EXPECT_LE(join(none, 0).size(), join(some, 0).size());
  const auto decoded = fba::decode(join(some, 0));
  for (const fba::Plane& plane : decoded->planes) EXPECT_EQ(plane.start_code, plane.intra);
}

TEST(LiveEncoder, GoesOnAfterAnError) {
  const fap::Sequence clip = calm_clip(10);
  fba::LiveEncoder encoder({.fap_quant = 0});
  Sent sent;
  for (std::size_t i = 0; i < 10; ++i) {
    fap::Frame frame = clip.frames[i];
    if (i == 5) {
      frame.value[5] = 100000;
      auto refused = encoder.write(frame);
      ASSERT_FALSE(refused);
      EXPECT_EQ(refused.error().code, Code::out_of_range);
    }
    auto unit = encoder.write(clip.frames[i]);
    ASSERT_TRUE(unit);
    sent.units.push_back(*unit);
    sent.frames.push_back(encoder.reconstruction());
  }
  sent.units.push_back(encoder.finish());
  expect_decodes(sent, 0);
}

TEST(LiveEncoder, SkipsAndBodies) {
  fba::LiveEncoder encoder({.intra_seconds = 10 / 25.0});
  fba::BodyFrame body;
  body.mask.set(1);
  std::vector<std::uint8_t> stream;
  const fap::Sequence clip = calm_clip(30);
  for (int i = 0; i < 30; ++i) {
    body.value[1] = 1000 * i;
    auto unit =
        encoder.write(clip.frames[std::size_t(i)], i == 4 ? 20 : 0, i >= 12 ? &body : nullptr);
    ASSERT_TRUE(unit) << unit.error().describe();
    stream.insert(stream.end(), unit->begin(), unit->end());
  }
  const auto end = encoder.finish();
  stream.insert(stream.end(), end.begin(), end.end());
  auto decoded = fba::decode(stream);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  ASSERT_EQ(decoded->planes.size(), 30U);
  EXPECT_EQ(decoded->planes[5].number, 25);
  EXPECT_FALSE(decoded->planes[11].body);
  EXPECT_TRUE(decoded->planes[12].intra);
  ASSERT_TRUE(decoded->planes[29].body);
  EXPECT_NEAR(decoded->planes[29].body->value[1], 29000, 128);
}

TEST(LiveEncoder, RefusesOptionsOutOfBounds) {
  const fap::Frame frame;
  EXPECT_EQ(fba::LiveEncoder({.fap_quant = 32}).write(frame).error().code, Code::invalid_argument);
  EXPECT_EQ(fba::LiveEncoder({.intra_seconds = -1}).write(frame).error().code,
            Code::invalid_argument);
  EXPECT_EQ(fba::LiveEncoder({.rate = {10, 3}}).write(frame).error().code, Code::invalid_argument);
}

// What a delayed encoder writes, unit by unit.
std::vector<std::vector<std::uint8_t>> send_delayed(const fap::Sequence& clip,
                                                    const fba::LiveOptions& options,
                                                    std::size_t delay) {
  std::vector<std::vector<std::uint8_t>> units;
  fba::LiveEncoder encoder(options);
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    const auto unit = encoder.write(clip.frames[i]);
    EXPECT_TRUE(unit) << unit.error().describe();
    if (!unit) return units;
    EXPECT_EQ(unit->empty(), i < delay);
    if (!unit->empty()) units.push_back(*unit);
    EXPECT_EQ(encoder.held(), std::min(i + 1, delay));
  }
  std::vector<std::uint8_t> unit;
  while (encoder.held() > 0) {
    EXPECT_TRUE(encoder.write_held(unit));
    units.push_back(unit);
  }
  units.push_back(encoder.finish());
  return units;
}

TEST_P(Live, ADelayGivesTheRangesOfWhatComes) {
  fap::Sequence clip = calm_clip(130);
  if (GetParam() % 2 == 0) {
    clip = test::random_clip(GetParam(), 60);
    clip.rate = {25, 1};
    for (std::size_t i = 0; i < clip.frames.size(); ++i) {
      clip.frames[i].number = std::int64_t(i);
      clip.frames[i].mask = clip.frames[0].mask;
    }
  }
  fba::LiveOptions options;
  options.fap_quant = 1 + int(GetParam() % 4);
  options.intra_seconds = 1;
  const Sent at_once = send(clip, options);
  options.delay_seconds = 1;
  const auto units = send_delayed(clip, options, 25);
  ASSERT_EQ(units.size(), clip.frames.size() + 1);
  std::vector<std::uint8_t> stream;
  for (const auto& unit : units) stream.insert(stream.end(), unit.begin(), unit.end());
  const auto decoded = fba::decode(stream);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  ASSERT_EQ(decoded->planes.size(), clip.frames.size());
  // As tight as the changes from one intra plane to the next allow.
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= decoded->planes.size(); ++i) {
    if (i < decoded->planes.size() && !decoded->planes[i].intra) continue;
    const fba::FaceSettings& settings = *decoded->planes[begin].face_settings;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!settings.mask[std::size_t(fap)]) continue;
      std::int64_t up = 0, down = 0;
      for (std::size_t k = begin + 1; k < i; ++k) {
        const std::int64_t change = std::int64_t(decoded->planes[k].face.value[std::size_t(fap)]) -
                                    decoded->planes[k - 1].face.value[std::size_t(fap)];
        up = std::max(up, change);
        down = std::max(down, -change);
      }
      const int unit = fap::info(fap).quant_step * 60;  // a range number, as a value
      EXPECT_EQ(settings.range[fba::kPredictiveMax][std::size_t(fap)], (up + unit - 1) / unit);
      EXPECT_EQ(settings.range[fba::kPredictiveMin][std::size_t(fap)], (down + unit - 1) / unit);
    }
    begin = i;
  }
  if (GetParam() % 2 != 0) {
    EXPECT_LT(stream.size(), join(at_once, 0).size());
  }
}

TEST(Live, ADelayIsCheckedAndMayBeLongerThanTheStream) {
  fba::LiveOptions options;
  options.delay_seconds = -1;
  EXPECT_EQ(fba::LiveEncoder(options).write({}).error().code, Code::invalid_argument);
  options.delay_seconds = std::nan("");
  EXPECT_EQ(fba::LiveEncoder(options).write({}).error().code, Code::invalid_argument);
  options.delay_seconds = 10;
  fba::LiveEncoder encoder(options);
  const fap::Sequence clip = calm_clip(30);
  for (const fap::Frame& frame : clip.frames) {
    const auto unit = encoder.write(frame);
    ASSERT_TRUE(unit);
    EXPECT_TRUE(unit->empty());
  }
  const auto decoded = fba::decode(encoder.finish());
  ASSERT_TRUE(decoded) << decoded.error().describe();
  EXPECT_EQ(decoded->planes.size(), 30U);
}

}  // namespace live_test
}  // namespace animeme
