// encode() and LiveEncoder at the limits of numbers: gaps, values of 32 bits, ranges, and what an
// error leaves behind.
#include <gtest/gtest.h>

#include <limits>

#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "codec/encode/live.h"

namespace animeme {
namespace encode_limits_test {

using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t kMin64 = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kMax64 = std::numeric_limits<std::int64_t>::max();

fap::Sequence row_of(int fap, const std::vector<std::int32_t>& values) {
  fap::Sequence clip;
  for (const std::int32_t value : values) {
    fap::Frame frame;
    frame.number = std::int64_t(clip.frames.size());
    frame.set(fap, value);
    clip.frames.push_back(frame);
  }
  return clip;
}

TEST(EncodeLimits, GapsUpToAMillionFrames) {
  for (const std::int64_t first : {std::int64_t(0), kMin64, std::int64_t(-5)}) {
    fap::Sequence clip = row_of(5, {1, 2});
    clip.frames[0].number = first;
    clip.frames[1].number = first + 1048577;  // 1 << 20 frames are skipped
    const auto stream = fba::encode(clip);
    ASSERT_TRUE(stream) << stream.error().describe();
    EXPECT_EQ(fba::decode(*stream)->planes[1].number, 1048577);
  }
  for (const auto& [first, second] : {std::pair<std::int64_t, std::int64_t>{0, 1048578},
                                      {0, 4294967297},  // 32 bits of it are 1
                                      {kMin64, kMax64},
                                      {-1, kMax64}}) {
    fap::Sequence clip = row_of(5, {1, 2});
    clip.frames[0].number = first;
    clip.frames[1].number = second;
    EXPECT_EQ(fba::encode(clip).error().code, Code::invalid_argument) << first << " " << second;
  }
}

TEST(EncodeLimits, StillPlanesAreNotSkippedBeyondAMillion) {
  // Three gaps that can be coded each, but not as one.
  fap::Sequence clip = row_of(5, {0, 0, 0, 7});
  for (fap::Frame& frame : clip.frames) frame.number *= 700000;
  fba::EncodeOptions options = fba::file_options();
  options.skip_still = true;
  const auto stream = fba::encode(clip, options);
  ASSERT_TRUE(stream) << stream.error().describe();
  const auto decoded = fba::decode(*stream);
  EXPECT_EQ(decoded->planes.back().number, 2100000);
}

// A frame with FAP 1 and 2 at their bounds.
fap::Frame legal_frame() {
  fap::Frame frame;
  frame.mask.set(1).set(2);
  frame.viseme = {14, 14, 63, false};
  frame.expression = {6, 63, 6, 63, false, false};
  return frame;
}

// The same with one value beyond its upper bound, or its lower one.
std::vector<fap::Frame> illegal_frames() {
  std::vector<fap::Frame> frames;
  for (const bool above : {true, false}) {
    const auto add = [&](auto part, auto member) {
      frames.push_back(legal_frame());
      std::int32_t& value = frames.back().*part.*member;
      value = above ? value + 1 : -1;
    };
    add(&fap::Frame::viseme, &fap::Viseme::select1);
    add(&fap::Frame::viseme, &fap::Viseme::select2);
    add(&fap::Frame::viseme, &fap::Viseme::blend);
    add(&fap::Frame::expression, &fap::Expression::select1);
    add(&fap::Frame::expression, &fap::Expression::intensity1);
    add(&fap::Frame::expression, &fap::Expression::select2);
    add(&fap::Frame::expression, &fap::Expression::intensity2);
  }
  return frames;
}

TEST(EncodeLimits, VisemesAndExpressionsOutOfBoundsInAnyPlane) {
  for (const fap::Frame& illegal : illegal_frames()) {
    for (const std::size_t at : {0, 2}) {  // an intra plane and a predictive one
      fap::Sequence clip;
      clip.frames.assign(3, legal_frame());
      clip.frames[at] = illegal;
      for (std::size_t i = 0; i < 3; ++i) clip.frames[i].number = std::int64_t(i);
      const auto stream = fba::encode(clip);
      ASSERT_FALSE(stream);
      EXPECT_EQ(stream.error().code, Code::out_of_range);
      EXPECT_EQ(stream.error().message.find("frame " + std::to_string(at)), 0U);

      fba::LiveEncoder live;
      for (std::size_t i = 0; i < at; ++i) ASSERT_TRUE(live.write(clip.frames[i]));
      const fap::Frame before = live.reconstruction();
      const auto unit = live.write(illegal);
      ASSERT_FALSE(unit);
      EXPECT_EQ(unit.error().code, Code::out_of_range);
      EXPECT_TRUE(live.reconstruction() == before);
      ASSERT_TRUE(live.write(legal_frame()));
      EXPECT_EQ(live.intra(), at == 0) << "an intra plane after an error that changed nothing";
    }
  }
}

TEST(EncodeLimits, WhatIsNotCodedMayBeAnything) {
  fap::Frame frame = legal_frame();
  frame.expression.intensity1 = 64;
  frame.mask.reset(2);
  fap::Sequence clip;
  clip.frames = {frame};
  EXPECT_TRUE(fba::encode(clip));
  frame.mask.set(2);
  EXPECT_FALSE(fba::LiveEncoder().write(frame));
  EXPECT_TRUE(fba::LiveEncoder({.faps = fap::Mask().set(1)}).write(frame));
}

TEST(EncodeLimits, ReconstructionsStayWithin32Bits) {
  // By steps that predictive planes can code up to the largest number.
  constexpr int kMost = std::numeric_limits<std::int32_t>::max();
  std::vector<std::int32_t> values;
  const std::int64_t step = 31LL * fap::info(48).quant_step * 59;
  for (std::int64_t value = 0; value < kMost; value += step) values.push_back(int(value));
  ASSERT_LT(values.size(), 10000U);
  for (const int sign : {1, -1}) {
    for (const int last : {kMost, kMost - 2000}) {
      std::vector<std::int32_t> row = values;
      row.push_back(last);
      for (std::int32_t& value : row) value *= sign;
      const auto stream = fba::encode(row_of(48, row), {.fap_quant = 31});
      if (stream) {
        EXPECT_TRUE(fba::decode(*stream));
      } else {
        EXPECT_EQ(stream.error().code, Code::out_of_range);
        EXPECT_NE(stream.error().message.find("32 bits"), std::string::npos);
      }
    }
  }
  // The same by the encoder that does as it is told.
  fba::FaceSettings settings;
  settings.fap_quant = 31;
  settings.send_range.fill(true);
  settings.mask.set(48);
  settings.mask_type[6] = fba::MaskType::hold;
  for (auto& set : settings.range) set.fill(31);
  fba::Encoder encoder;
  fba::PlaneInput plane;
  plane.face_settings = &settings;
  bool refused = false;
  fap::Frame frame;
  for (std::size_t i = 0; i <= values.size(); ++i) {
    frame.set(48, i < values.size() ? values[i] : kMost);
    plane.intra = i == 0;
    plane.face = &frame;
    const auto ok = encoder.write(plane);
    if (ok) continue;
    EXPECT_EQ(ok.error().code, Code::out_of_range);
    refused = true;
  }
  const auto decoded = fba::decode(encoder.finish());
  ASSERT_TRUE(decoded) << decoded.error().describe();
  EXPECT_EQ(decoded->planes.size(), values.size() + (refused ? 0U : 1U));
}

// The nearest that planes can tell: 1860 steps in an intra plane, as many more in each behind it.
TEST(EncodeLimits, ValuesTooFarAreFollowed) {
  ASSERT_EQ(fap::info(14).quant_step, 1);
  std::vector<std::int32_t> row(12, 0);
  for (std::size_t i = 2; i < 8; ++i) row[i] = 5000;
  for (std::size_t i = 8; i < 12; ++i) row[i] = -1900;
  for (const bool file : {false, true}) {
    fba::EncodeReport report;
    const auto stream = fba::encode(row_of(14, row),
                                    file ? fba::file_options() : fba::EncodeOptions(), {}, &report);
    ASSERT_TRUE(stream) << stream.error().describe();
    EXPECT_GT(report.limited, 2U);
    const auto decoded = fba::decode(*stream);
    ASSERT_TRUE(decoded);
    std::vector<std::int32_t> shown;
    for (const fba::Plane& plane : decoded->planes) shown.push_back(plane.face.value[14]);
    EXPECT_EQ(shown, (std::vector<std::int32_t>{0, 0, 1860, 3720, 5000, 5000, 5000, 5000, -1860,
                                                -1900, -1900, -1900}));
  }
}

TEST(EncodeLimits, PeriodsAreSecondsWhereFramesAreSkipped) {
  fap::Sequence clip;
  clip.rate = {60, 1};
  fap::Frame frame;
  for (int i = 0; i < 100; ++i) {
    frame.number = 6 * i;
    frame.set(3, 10 * (i % 3));
    clip.frames.push_back(frame);
  }
  fba::EncodeOptions options;
  options.intra_seconds = 1;
  const auto stream = fba::encode(clip, options);
  ASSERT_TRUE(stream);
  const auto decoded = fba::decode(*stream);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(decoded->planes[i].intra, i % 10 == 0) << i;
}

TEST(EncodeLimits, ExtraIntraPlanesOnlyWhereTheyCanBe) {
  // FAP 5 climbs by predictive planes to where no intra plane can code it; FAP 6 to 16 jump there.
  fap::Sequence clip;
  for (int i = 0; i < 400; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(5, 20 * i);
    for (int fap = 6; fap <= 18; ++fap) {
      frame.set(fap, (i < 300 ? 0 : 1700 * fap::info(fap).quant_step) + i % 3);
    }
    clip.frames.push_back(frame);
  }
  ASSERT_TRUE(fba::encode(clip));
  const auto stream = fba::encode(clip, fba::file_options());
  EXPECT_TRUE(stream) << stream.error().describe();
}

TEST(EncodeLimits, DefinitionsHappenOnce) {
  fap::Sequence clip = row_of(3, {0, 8, 16, 24});
  clip.frames[1].mask.set(1).set(2);
  clip.frames[1].viseme = {3, 4, 20, true};
  clip.frames[1].expression = {1, 2, 3, 4, true, true};
  const auto stream = fba::encode(clip);
  ASSERT_TRUE(stream);
  const auto decoded = fba::decode(*stream);
  for (std::size_t i = 0; i < 4; ++i) {
    const fap::Frame& face = decoded->planes[i].face;
    EXPECT_EQ(face.viseme.select1, i == 0 ? 0 : 3) << i;
    EXPECT_EQ(face.viseme.def, i == 1) << i;
    EXPECT_EQ(face.expression.def, i == 1) << i;
    EXPECT_EQ(face.expression.init_face, i == 1) << i;
  }
}

TEST(EncodeLimits, RatesThatCannotBeReachedGiveTheSmallestStream) {
  std::vector<std::int32_t> values;
  for (int i = 0; i < 60; ++i) values.push_back(i * i % 301);
  const fap::Sequence clip = row_of(5, values);
  const auto size_at = [&clip](double rate) {
    fba::EncodeOptions options = fba::file_options();
    options.max_bits_per_second = rate;
    const auto stream = fba::encode(clip, options);
    EXPECT_TRUE(stream);
    return stream ? stream->size() : 0;
  };
  const std::size_t least = size_at(1);
  EXPECT_LT(least, fba::encode(clip, fba::file_options())->size());
  // Half of that: what the headers take too much is about all that was allowed.
  const double half = double(least) * 4 / clip.duration();
  for (double factor = 0.99; factor < 1.01; factor += 0.0005) {
    EXPECT_EQ(size_at(half * factor), least) << factor;
  }
}

TEST(LiveLimits, AnErrorLeavesNoTrace) {
  fba::LiveEncoder encoder({.intra_seconds = 20 / 25.0});
  fba::LiveEncoder other({.intra_seconds = 20 / 25.0});
  fap::Frame frame;
  frame.mask.set(1);
  for (int i = 0; i < 100; ++i) {
    frame.set(5, 10 * (i % 4));
    frame.viseme.select1 = i % 15;
    if (i % 7 == 3) {
      fap::Frame bad = frame;
      bad.set(5, 1000000);
      bad.set(30, 5);
      bad.viseme.select1 = 15;
      const fap::Frame shown = encoder.reconstruction();
      const bool intra = encoder.intra();
      ASSERT_FALSE(encoder.write(bad));
      EXPECT_EQ(encoder.reconstruction(), shown);
      EXPECT_EQ(encoder.intra(), intra);
    }
    ASSERT_TRUE(encoder.write(frame));
    ASSERT_TRUE(other.write(frame));
    EXPECT_EQ(encoder.reconstruction(), other.reconstruction());
  }
  // The motion of frames that were refused does not widen the ranges.
  for (int i = 0; !encoder.intra(); ++i) {
    ASSERT_LT(i, 30);
    ASSERT_TRUE(encoder.write(frame));
  }
  frame.set(5, frame.value[5] + 61 * fap::info(5).quant_step);
  ASSERT_TRUE(encoder.write(frame));
  EXPECT_TRUE(encoder.intra()) << "the range of FAP 5 should be 60 levels";
}

TEST(LiveLimits, BitZeroOfAMaskIsNoFap) {
  fba::LiveEncoder encoder({.faps = fap::Mask().set(0).set(5)});
  fap::Frame frame;
  frame.set(5, 10);
  frame.mask.set(0);
  const auto unit = encoder.write(frame);
  ASSERT_TRUE(unit) << unit.error().describe();
  EXPECT_EQ(encoder.reconstruction().mask, fap::Mask().set(5));
  const auto next = encoder.write(frame);
  EXPECT_TRUE(next) << next.error().describe();
}

}  // namespace encode_limits_test
}  // namespace animeme
