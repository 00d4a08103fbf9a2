// One stream for receivers that join at any time: each gets the values of the source, and intra
// planes only where it begins.
#include "codec/encode/fan_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "codec/decode/plane_header.h"
#include "codec/encode/encode.h"
#include "codec/encode/live.h"
#include "codec/encode/splice.h"
#include "tests/support/files.h"
#include "tests/support/random_clip.h"
#include "tests/support/reference_streams.h"

namespace animeme {
namespace fan_out_test {

using Bytes = std::vector<std::uint8_t>;

constexpr int kIntra = 12;  // planes from one intra plane of the source to the next

// A live stream of a clip that does not change its FAPs.
std::vector<Bytes> live_units(std::uint64_t seed, int frames) {
  fap::Sequence clip = test::random_clip(seed, frames);
  for (fap::Frame& frame : clip.frames) frame.mask = clip.frames.front().mask;
  fba::LiveOptions options;
  options.rate = clip.rate = {25, 1};
  options.intra_seconds = kIntra / 25.0;
  fba::LiveEncoder encoder(options);
  std::vector<Bytes> units;
  for (const fap::Frame& frame : clip.frames) {
    auto unit = encoder.write(frame);
    EXPECT_TRUE(unit) << unit.error().describe();
    if (unit) units.push_back(std::move(*unit));
  }
  return units;
}

std::vector<Bytes> units_of(const Bytes& stream) {
  std::vector<Bytes> out;
  const auto units = fba::split_access_units(stream);
  if (!units) return out;
  for (const fba::AccessUnit& unit : units->units) out.push_back(unit.bytes);
  return out;
}

// What a receiver has got.
struct Got {
  std::size_t first = 0, intra = 0, bits = 0;
  Bytes stream;
};

// Every receiver joins before the unit `joins` says. Checks all values.
std::map<fba::FanOut::Receiver, Got> run(fba::FanOut& fan, const std::vector<Bytes>& units,
                                         const std::vector<std::size_t>& joins) {
  std::map<fba::FanOut::Receiver, Got> all;
  Bytes whole;
  for (std::size_t i = 0; i < units.size(); ++i) {
    whole.insert(whole.end(), units[i].begin(), units[i].end());
    fan.push(units[i]);
    for (std::size_t k = 0; k < joins.size(); ++k) {
      if (joins[k] > i) continue;
      const fba::FanOut::Unit unit = fan.unit_for(k);
      Got& got = all[k];
      if (got.stream.empty()) {
        got.first = i;
        EXPECT_TRUE(unit.intra);
      }
      got.intra += unit.intra;
      got.bits += unit.bytes.size() * 8;
      got.stream.insert(got.stream.end(), unit.bytes.begin(), unit.bytes.end());
    }
  }
  const auto source = fba::decode(whole);
  EXPECT_TRUE(source) << source.error().describe();
  for (const auto& [receiver, got] : all) {
    const auto decoded = fba::decode(got.stream);
    EXPECT_TRUE(decoded) << receiver << ": " << decoded.error().describe();
    if (!decoded || !source) continue;
    EXPECT_EQ(decoded->planes.size() + got.first, source->planes.size());
    for (std::size_t i = 0; i < decoded->planes.size(); ++i) {
      const fba::Plane& want = source->planes[got.first + i];
      const fba::Plane& plane = decoded->planes[i];
      for (std::size_t fap = 3; fap <= std::size_t(fap::kFapCount); ++fap) {
        if (!want.face.mask[fap]) continue;
        EXPECT_TRUE(plane.face.mask[fap]) << receiver << " plane " << i << " FAP " << fap;
        EXPECT_EQ(plane.face.value[fap], want.face.value[fap])
            << receiver << " plane " << i << " FAP " << fap;
      }
      if (want.face.mask[1]) {
        EXPECT_EQ(plane.face.viseme, want.face.viseme);
      }
      if (want.body) {
        EXPECT_TRUE(plane.body) << receiver << " plane " << i;
        for (std::size_t bap = 1; plane.body && bap <= std::size_t(fba::kBapCount); ++bap) {
          if (!want.body->mask[bap]) continue;
          EXPECT_EQ(plane.body->value[bap], want.body->value[bap])
              << receiver << " plane " << i << " BAP " << bap;
        }
      }
      EXPECT_EQ(plane.temporal.skip.value_or(0), want.temporal.skip.value_or(0));
      if (::testing::Test::HasFailure()) return all;
    }
  }
  return all;
}

TEST(FanOut, ReceiversHaveTheValuesOfTheSource) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const std::vector<Bytes> units = live_units(seed, 150);
    fba::FanOut fan;
    test::Random random(seed);
    std::vector<std::size_t> joins = {0, 0};
    for (int i = 0; i < 6; ++i) joins.push_back(std::size_t(random.range(0, 140)));
    run(fan, units, joins);
    ASSERT_FALSE(HasFailure()) << seed;
  }
}

// Whether an intra plane can code what is shown at some plane. (Predictive planes reach further.)
bool can_join(const std::vector<Bytes>& units, std::size_t join) {
  Bytes whole;
  for (const Bytes& unit : units) whole.insert(whole.end(), unit.begin(), unit.end());
  const auto source = fba::decode(whole);
  if (!source) return false;
  fba::Splicer splicer;
  for (std::size_t i = 0; i < source->planes.size(); ++i) {
    if (i < join) {
      splicer.pass(source->planes[i]);
    } else if (!splicer.copy(source->planes[i])) {
      return false;
    }
  }
  return splicer.report().changed == 0;
}

TEST(FanOut, StreamsOfTheSuiteInOneAndTheOther) {
  std::size_t streams = 0;
  for (const auto& base : test::reference_streams()) {
    const auto units = units_of(test::read_bytes(base.string() + ".fba"));
    if (units.size() < 8 || units.size() > 400) continue;
    fba::FanOut fan;
    fan.push(units[0]);
    if (!fan.ready()) continue;
    std::vector<std::size_t> joins;
    for (const std::size_t join :
         {std::size_t(0), std::size_t(3), std::size_t(5), units.size() / 2}) {
      if (can_join(units, join)) joins.push_back(join);
    }
    fba::FanOut again;
    run(again, units, joins);
    ASSERT_FALSE(HasFailure()) << base;
    ++streams;
  }
  EXPECT_GT(streams, 60u);
}

// At rest most of the time, as live faces are: hardly a bit of the intra planes is left.
TEST(FanOut, IntraPlanesAreOnlyWhereAReceiverBegins) {
  fap::Sequence clip = test::random_clip(5, 400);
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    const fap::Frame& from = clip.frames[i % 50 / 5];
    clip.frames[i].mask = clip.frames.front().mask;
    clip.frames[i].value = from.value;
    clip.frames[i].viseme = clip.frames.front().viseme;
    clip.frames[i].expression = clip.frames.front().expression;
  }
  clip.rate = {25, 1};
  fba::EncodeOptions options;
  options.intra_seconds = kIntra / 25.0;
  const auto stream = fba::encode(clip, options);
  ASSERT_TRUE(stream) << stream.error().describe();
  const auto units = units_of(*stream);
  std::size_t bits = 0;
  for (const Bytes& unit : units) bits += unit.size() * 8;
  fba::FanOut fan;
  const auto got = run(fan, units, {0, 0, 100, 301});
  EXPECT_EQ(fan.encoders(), 3u);
  EXPECT_EQ(got.at(0).intra, 1u);
  EXPECT_EQ(got.at(2).intra, 1u);
  EXPECT_EQ(got.at(3).intra, 1u);
  EXPECT_LT(got.at(0).bits, bits * 2 / 3);
}

TEST(FanOut, EncodersAreFew) {
  const auto units = live_units(3, 200);
  fba::FanOut fan(4);
  std::vector<std::size_t> joins;
  for (std::size_t i = 0; i < 100; ++i) joins.push_back(i);
  run(fan, units, joins);
  EXPECT_EQ(fan.encoders(), 1u);  // they came to the same intra plane of the source
}

TEST(FanOut, ForgottenReceiversBeginAnew) {
  const auto units = live_units(4, 30);
  fba::FanOut fan;
  for (std::size_t i = 0; i < 5; ++i) fan.push(units[i]);
  EXPECT_TRUE(fan.unit_for(1).intra);
  fan.push(units[5]);
  EXPECT_FALSE(fan.unit_for(1).intra);
  EXPECT_FALSE(fan.unit_for(1).intra);  // the same unit
  fan.forget(1);
  EXPECT_TRUE(fan.unit_for(1).intra);
  fan.forget(1);
  fan.forget(7);
  fan.push(units[6]);
  EXPECT_EQ(fan.encoders(), 0u);
}

TEST(FanOut, WhatCannotBeDecodedIsPassedOn) {
  const auto units = live_units(6, 60);
  fba::FanOut fan;
  EXPECT_FALSE(fan.ready());
  const auto predictive = std::find_if(units.begin(), units.end(), [](const Bytes& unit) {
    return !fba::read_plane_header(unit)->intra;
  });
  ASSERT_NE(predictive, units.end());
  fan.push(*predictive);
  EXPECT_FALSE(fan.ready());
  EXPECT_EQ(fan.unit_for(1).bytes.size(), predictive->size());
  EXPECT_FALSE(fan.unit_for(1).intra);
  fan.push(units[0]);
  EXPECT_TRUE(fan.ready());
  EXPECT_TRUE(fan.unit_for(1).intra);
  const Bytes noise = {0, 0, 1, 0xBB, 0xFF, 0xFF, 0xFF, 0x12};
  fan.push(noise);
  EXPECT_FALSE(fan.ready());
  EXPECT_EQ(fan.unit_for(1).bytes.size(), noise.size());
  for (std::size_t i = 1; i < units.size() && !fan.ready(); ++i) fan.push(units[i]);
  EXPECT_TRUE(fan.ready());
  EXPECT_TRUE(fan.unit_for(1).intra);
}

}  // namespace fan_out_test
}  // namespace animeme
