// Properties: whatever encode() takes comes back, within the quantiser and exactly at quantiser 0.
#include <gtest/gtest.h>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "tests/support/random_clip.h"

namespace animeme {
namespace roundtrip_test {

// The clip as a receiver holds it: values that a frame leaves out stay.
fap::Sequence held(const fap::Sequence& clip) {
  fap::Sequence out = clip;
  fap::Frame last;
  fap::Mask used;
  for (const fap::Frame& frame : clip.frames) used |= frame.mask;
  for (fap::Frame& frame : out.frames) {
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (frame.mask[fap]) last.value[fap] = frame.value[fap];
    }
    frame.value = last.value;
    frame.mask = used;
  }
  return out;
}

class RoundTrip : public testing::TestWithParam<int> {};

TEST_P(RoundTrip, LosslessWithoutQuantiser) {
  const fap::Sequence clip = test::random_clip(std::uint64_t(GetParam()), 60, true);
  fba::EncodeOptions options;
  options.fap_quant = 0;
  options.intra_seconds = (GetParam() % 17) / 25.0;
  auto stream = fba::encode(clip, options);
  ASSERT_TRUE(stream) << stream.error().describe();
  auto decoded = fba::decode(*stream);
  ASSERT_TRUE(decoded) << decoded.error().describe();
  EXPECT_TRUE(decoded->warnings.empty());
  const fap::Sequence got = fba::face_sequence(*decoded);
  const fap::Sequence want = held(clip);
  EXPECT_EQ(got.rate, want.rate);
  ASSERT_EQ(got.frames.size(), want.frames.size());
  for (std::size_t i = 0; i < got.frames.size(); ++i) {
    ASSERT_EQ(got.frames[i], want.frames[i]) << "frame " << i;
  }
}

TEST_P(RoundTrip, ErrorStaysWithinHalfAStep) {
  const fap::Sequence clip = test::random_clip(std::uint64_t(GetParam()) + 1000, 80);
  for (const int quant : {1, 2, 7, 31}) {
    fba::EncodeOptions options;
    options.fap_quant = quant;
    options.stream.plane_start_codes = fba::PlaneStartCodes(GetParam() % 3);
    auto stream = fba::encode(clip, options);
    ASSERT_TRUE(stream) << stream.error().describe();
    auto decoded = fba::decode(*stream);
    ASSERT_TRUE(decoded) << decoded.error().describe();
    const fap::Sequence got = fba::face_sequence(*decoded);
    const fap::Sequence want = held(clip);
    ASSERT_EQ(got.frames.size(), want.frames.size());
    for (std::size_t i = 0; i < got.frames.size(); ++i) {
      ASSERT_EQ(got.frames[i].mask, want.frames[i].mask);
      for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        const std::size_t n = std::size_t(fap);
        const int step = fap::info(fap).quant_step * quant;
        ASSERT_LE(std::abs(got.frames[i].value[n] - want.frames[i].value[n]), step / 2)
            << "FAP " << fap << " frame " << i << " quant " << quant;
      }
      EXPECT_EQ(got.frames[i].viseme.select1, want.frames[i].viseme.select1);
      EXPECT_EQ(got.frames[i].expression.def, want.frames[i].expression.def);
      EXPECT_LE(std::abs(got.frames[i].viseme.blend - want.frames[i].viseme.blend), quant);
    }
  }
}

TEST_P(RoundTrip, ReconstructionIsWhatTheDecoderHas) {
  const fap::Sequence clip = test::random_clip(std::uint64_t(GetParam()) + 2000, 20);
  fba::EncodeOptions options;
  options.fap_quant = 5;
  auto stream = fba::encode(clip, options);
  ASSERT_TRUE(stream) << stream.error().describe();
  auto once = fba::decode(*stream);
  ASSERT_TRUE(once);
  // Coding the decoded values again changes nothing more.
  auto again = fba::encode(fba::face_sequence(*once), options);
  ASSERT_TRUE(again) << again.error().describe();
  auto twice = fba::decode(*again);
  ASSERT_TRUE(twice);
  for (std::size_t i = 0; i < once->planes.size(); ++i) {
    EXPECT_EQ(once->planes[i].face.value, twice->planes[i].face.value);
  }
}

TEST_P(RoundTrip, AccessUnitsKeepTimesAndValues) {
  const fap::Sequence clip = test::random_clip(std::uint64_t(GetParam()) + 3000, 30, true);
  fba::EncodeOptions options;
  options.intra_seconds = clip.rate.seconds(8);
  auto stream = fba::encode(clip, options);
  ASSERT_TRUE(stream) << stream.error().describe();
  auto units = fba::split_access_units(*stream);
  ASSERT_TRUE(units) << units.error().describe();
  ASSERT_EQ(units->units.size(), clip.frames.size());
  auto decoded = fba::decode(*stream);
  ASSERT_TRUE(decoded);
  std::size_t since_intra = 0;
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    since_intra = decoded->planes[i].intra ? 0 : since_intra + 1;
    EXPECT_LT(since_intra, 8u);
    EXPECT_EQ(units->units[i].intra, decoded->planes[i].intra);
    EXPECT_NEAR(double(units->units[i].time) / units->timescale,
                clip.rate.seconds(double(clip.frames[i].number)), 1e-9);
  }
  EXPECT_EQ(units->config.size(), 11u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RoundTrip, testing::Range(1, 25));

TEST(Encode, RefusesWhatItCannotCode) {
  fap::Sequence clip;
  EXPECT_EQ(fba::encode(clip).error().code, Code::invalid_argument);
  fap::Frame frame;
  frame.set(14, 2000);
  clip.frames = {frame};
  auto too_big = fba::encode(clip, {.fap_quant = 0});
  ASSERT_FALSE(too_big);
  EXPECT_EQ(too_big.error().code, Code::out_of_range);
  EXPECT_NE(too_big.error().message.find("thrust_jaw"), std::string::npos);
  clip.frames[0].value[14] = 1860;
  EXPECT_TRUE(fba::encode(clip));
  clip.rate = {1, 3};
  EXPECT_EQ(fba::encode(clip).error().code, Code::unsupported);
  clip.rate = {25, 1};
  clip.frames.push_back(clip.frames[0]);
  EXPECT_EQ(fba::encode(clip).error().code, Code::invalid_argument);
  clip.frames[1].number = 1;
  EXPECT_TRUE(fba::encode(clip));
  EXPECT_EQ(fba::encode(clip, {.fap_quant = 32}).error().code, Code::invalid_argument);
  clip.frames[0].mask.set(1);
  clip.frames[0].viseme.select1 = 15;
  EXPECT_EQ(fba::encode(clip).error().code, Code::out_of_range);
}

TEST(Encode, LargeStepsBecomeIntraPlanes) {
  fap::Sequence clip;
  for (int i = 0; i < 6; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(15, i % 2 == 0 ? 1800 : -1800);  // a difference of 3600 fits no predictive range
    clip.frames.push_back(frame);
  }
  auto stream = fba::encode(clip);
  ASSERT_TRUE(stream) << stream.error().describe();
  auto decoded = fba::decode(*stream);
  ASSERT_TRUE(decoded);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_TRUE(decoded->planes[i].intra);
    EXPECT_EQ(decoded->planes[i].face.value[15], clip.frames[i].value[15]);
  }
}

// The widest range holds a difference of 1860: one more needs an intra plane, none less does.
TEST(Encode, StepsThatARangeHoldsStayPredicted) {
  const std::vector<std::pair<std::vector<int>, std::vector<bool>>> clips = {
      {{0, 1860, 0, -1860, 0}, {true, false, false, false, false}},
      {{-1, 1860, 1859}, {true, true, false}},
      {{1, -1860, -1859}, {true, true, false}},
      {{900, -960, 900, -961, 900}, {true, false, false, true, true}},
  };
  for (const auto& [values, intra] : clips) {
    fap::Sequence clip;
    for (const int value : values) {
      fap::Frame frame;
      frame.number = std::int64_t(clip.frames.size());
      frame.set(15, value);
      clip.frames.push_back(frame);
    }
    const auto stream = fba::encode(clip);
    ASSERT_TRUE(stream) << stream.error().describe();
    const auto decoded = fba::decode(*stream);
    ASSERT_TRUE(decoded);
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_EQ(decoded->planes[i].intra, intra[i]) << values[0] << " " << i;
      EXPECT_EQ(decoded->planes[i].face.value[15], values[i]) << values[0] << " " << i;
    }
  }
}

// Each rate that a stream can express, whole or not, has exact times in ticks.
TEST(AccessUnits, TimesAreExactAtEachRate) {
  const std::vector<fap::Rate> rates = {{25, 1},       {1, 1},        {25, 2},       {401, 16},
                                        {30000, 1001}, {24000, 1001}, {15000, 1001}, {125, 8},
                                        {255, 1},      {1, 16},       {59, 4},       {60000, 1001}};
  for (const fap::Rate rate : rates) {
    fap::Sequence clip;
    clip.rate = rate;
    for (const int number : {0, 1, 2, 4, 5}) {
      fap::Frame frame;
      frame.number = number;
      frame.set(3, 10 * number);
      clip.frames.push_back(frame);
    }
    const auto stream = fba::encode(clip);
    ASSERT_TRUE(stream) << rate.num << "/" << rate.den << ": " << stream.error().describe();
    const auto units = fba::split_access_units(*stream);
    ASSERT_TRUE(units);
    EXPECT_GE(units->timescale, 10000u);
    for (std::size_t i = 0; i < clip.frames.size(); ++i) {
      EXPECT_EQ(units->units[i].time * std::int64_t(rate.num),
                clip.frames[i].number * std::int64_t(units->timescale) * std::int64_t(rate.den))
          << rate.num << "/" << rate.den << " frame " << i;
    }
  }
}

}  // namespace roundtrip_test
}  // namespace animeme
