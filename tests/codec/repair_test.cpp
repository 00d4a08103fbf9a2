// Streams with flipped bytes, lost units and cut ends: what is intact stays as it was, at its time.
#include "codec/decode/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "tests/support/files.h"
#include "tests/support/random_clip.h"
#include "tests/support/reference_streams.h"

namespace animeme {
namespace repair_test {

using Bytes = std::vector<std::uint8_t>;

constexpr int kFrames = 120, kIntra = 12;  // frames, and from one intra plane to the next

// A clip with an intra plane every twelve frames, in units as containers have them.
fba::AccessUnits units_of_clip(std::uint64_t seed, bool gaps = false) {
  fap::Sequence clip = test::random_clip(seed, kFrames, gaps);
  clip.rate = {25, 1};
  fba::EncodeOptions options;
  options.intra_seconds = gaps ? 4 : kIntra / 25.0;
  const auto stream = fba::encode(clip, options);
  EXPECT_TRUE(stream) << stream.error().describe();
  const auto units = fba::split_access_units(*stream);
  EXPECT_TRUE(units) << units.error().describe();
  return *units;
}

// Faces by the number of their frame.
std::map<std::int64_t, fap::Frame> faces(const Bytes& stream) {
  const auto decoded = fba::decode(stream);
  EXPECT_TRUE(decoded) << decoded.error().describe();
  std::map<std::int64_t, fap::Frame> all;
  if (!decoded) return all;
  for (const fba::Plane& plane : decoded->planes) all[plane.number] = plane.face;
  return all;
}

struct Kept {
  std::size_t same = 0, wrong = 0;
};

Kept compare(const std::map<std::int64_t, fap::Frame>& good,
             const std::map<std::int64_t, fap::Frame>& repaired) {
  Kept kept;
  for (const auto& [number, face] : repaired) {
    const auto at = good.find(number);
    ++(at != good.end() && at->second == face ? kept.same : kept.wrong);
  }
  return kept;
}

TEST(Repair, WhatIsIntactIsUnchanged) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    fba::AccessUnits units = units_of_clip(seed, seed % 2 == 0);
    const fba::AccessUnits before = units;
    const Bytes stream = fba::join_access_units(units);
    const auto repaired = fba::repair_stream(stream);
    ASSERT_TRUE(repaired) << repaired.error().describe();
    EXPECT_TRUE(repaired->damage.empty());
    EXPECT_EQ(repaired->stream, stream);
    const auto damage = fba::repair_units(units);
    ASSERT_TRUE(damage);
    EXPECT_TRUE(damage->empty());
    EXPECT_EQ(units, before);
  }
}

TEST(Repair, AFlippedByteCostsAtMostAnIntraPeriod) {
  std::size_t wrong = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const fba::AccessUnits units = units_of_clip(seed % 10 + 1);
    Bytes stream = fba::join_access_units(units);
    const auto good = faces(stream);
    test::Random random(seed);
    // Behind the first intra plane, without which a stream has no beginning.
    const std::size_t first = units.units.front().bytes.size();
    const auto at = first + random.next() % (stream.size() - first - 4);
    stream[at] ^= std::uint8_t(1 << random.range(0, 7));
    const auto repaired = fba::repair_stream(stream);
    ASSERT_TRUE(repaired) << repaired.error().describe();
    const auto left = faces(repaired->stream);
    const Kept kept = compare(good, left);
    EXPECT_GE(kept.same, good.size() - kIntra) << seed << ", byte " << at;
    wrong += kept.wrong;
    all += good.size();
    if (repaired->damage.empty()) continue;  // other values, which nobody can notice
    EXPECT_EQ(repaired->damage.size(), 1u);
    EXPECT_FALSE(repaired->damage[0].estimated);
    EXPECT_FALSE(repaired->damage[0].reason.empty());
    // All that comes behind the damage keeps its time.
    if (good.size() - kept.same < kIntra && left.rbegin()->first != good.rbegin()->first) {
      EXPECT_GE(left.rbegin()->first, std::int64_t(good.rbegin()->first) - kIntra);
    }
  }
  EXPECT_LT(wrong, all / 50);
}

TEST(Repair, LostUnitsOfAContainerKeepTheirTime) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    fba::AccessUnits units = units_of_clip(seed % 10 + 1, true);
    const auto good = faces(fba::join_access_units(units));
    test::Random random(seed);
    const auto first = std::size_t(random.range(1, kFrames - 2));
    const auto count = std::min<std::size_t>(std::size_t(random.range(1, 20)), kFrames - 1 - first);
    // As readers of containers do: predictive planes behind lost ones are left out.
    std::size_t end = first + count;
    while (end < units.units.size() && !units.units[end].intra) ++end;
    const std::size_t lost = end - first;
    const std::int64_t last = units.units.back().time;
    const bool at_end = end == units.units.size();
    units.units.erase(units.units.begin() + std::ptrdiff_t(first),
                      units.units.begin() + std::ptrdiff_t(end));
    const std::size_t gap[] = {first};
    const auto damage = fba::repair_units(units, at_end ? std::span<const std::size_t>() : gap);
    ASSERT_TRUE(damage);
    EXPECT_EQ(damage->size(), at_end ? 0u : 1u);
    const auto left = faces(fba::join_access_units(units));
    EXPECT_EQ(compare(good, left).same, good.size() - lost) << seed;
    if (at_end) continue;
    EXPECT_EQ(left.rbegin()->first, good.rbegin()->first) << seed;
    EXPECT_EQ(units.units.back().time, last);
  }
}

TEST(Repair, TheStandardFormOfADamage) {
  fba::AccessUnits units = units_of_clip(3);
  const auto good = faces(fba::join_access_units(units));
  units.units[30].bytes[3] = 0x55;  // its start code
  int lost = 1;
  while (!units.units[std::size_t(30 + lost)].intra) ++lost;
  std::size_t before = 0;
  for (std::size_t i = 0; i < 30; ++i) before += units.units[i].bytes.size();
  const std::size_t behind = before + units.units[30].bytes.size();
  const auto damage = fba::repair_units(units);
  ASSERT_TRUE(damage) << damage.error().describe();
  ASSERT_EQ(damage->size(), 1u);
  EXPECT_EQ((*damage)[0].frames, lost);
  EXPECT_DOUBLE_EQ((*damage)[0].seconds, 30 / 25.0);
  EXPECT_GE((*damage)[0].bit, std::int64_t(8 * before));  // of the units in a row
  EXPECT_LT((*damage)[0].bit, std::int64_t(8 * behind));
  EXPECT_THAT((*damage)[0].describe(), testing::StartsWith("at 1.20 s (bit "));
  EXPECT_THAT((*damage)[0].describe(),
              testing::EndsWith(": a plane has no start code; " + std::to_string(lost) +
                                " frames are lost"));
  ASSERT_EQ(units.units.size(), std::size_t(kFrames - lost));
  EXPECT_EQ(units.units[29].duration, (lost + 1) * units.units[28].duration);
  const auto left = faces(fba::join_access_units(units));
  EXPECT_EQ(compare(good, left).same, std::size_t(kFrames - lost));
}

TEST(Repair, ADamagedBeginningIsHeld) {
  fba::AccessUnits units = units_of_clip(4);
  Bytes stream = fba::join_access_units(units);
  const auto good = faces(stream);
  stream[12] ^= 0xFF;  // masks of the first plane
  const auto repaired = fba::repair_stream(stream);
  ASSERT_TRUE(repaired) << repaired.error().describe();
  const auto left = faces(repaired->stream);
  EXPECT_EQ(left.rbegin()->first, good.rbegin()->first);
  EXPECT_EQ(compare(good, left).same, std::size_t(kFrames - kIntra));
  ASSERT_EQ(left.count(0), 1u);
  EXPECT_EQ(left.at(0).value, good.at(kIntra).value);
}

TEST(Repair, ACutStreamKeepsWhatIsThere) {
  const fba::AccessUnits units = units_of_clip(5);
  const Bytes stream = fba::join_access_units(units);
  const auto good = faces(stream);
  for (std::size_t size = units.units.front().bytes.size() + 20; size < stream.size(); size += 37) {
    const auto cut = std::span(stream).first(size);
    const auto repaired = fba::repair_stream(cut);
    ASSERT_TRUE(repaired) << repaired.error().describe();
    // Cut between two planes, a stream lacks no more than its end code.
    EXPECT_EQ(repaired->damage.size(), fba::decode(cut) ? 0u : 1u);
    std::size_t whole = 0, begin = 0;
    for (; whole < units.units.size(); ++whole) {
      begin += units.units[whole].bytes.size();
      if (begin > size) break;
    }
    const Kept kept = compare(good, faces(repaired->stream));
    EXPECT_EQ(kept.same, whole) << size;
    EXPECT_EQ(kept.wrong, 0u);
  }
}

// The planes that end before a bit.
std::vector<fba::Plane> planes_before(const Bytes& stream, std::int64_t bit) {
  fba::Decoder decoder;
  decoder.push(stream);
  decoder.finish();
  std::vector<fba::Plane> planes;
  for (;;) {
    auto event = decoder.next();
    if (!event) return planes;
    if (event->kind != fba::Event::Kind::plane) continue;
    if (event->plane.bit_end > bit) return planes;
    planes.push_back(std::move(event->plane));
  }
}

// Flips bits, overwrites, cuts off, takes out and clears bytes: one of these, up to three times.
// Returns the first byte that is no longer what it was.
std::size_t hurt(Bytes& stream, test::Random& random) {
  std::size_t first = stream.size();
  const int kind = random.range(0, 4), times = random.range(1, 3);
  for (int i = 0; i < times && stream.size() > 16; ++i) {
    const auto at = std::size_t(random.range(0, int(stream.size()) - 1));
    const auto wanted = std::size_t(random.range(1, 188));
    const auto length = std::min(wanted, stream.size() - at);
    const auto from = stream.begin() + std::ptrdiff_t(at);
    first = std::min(first, at);
    if (kind == 0) *from ^= std::uint8_t(1 << random.range(0, 7));
    if (kind == 1) *from = std::uint8_t(random.range(0, 255));
    if (kind == 2) stream.resize(std::max<std::size_t>(8, at));
    if (kind == 3) stream.erase(from, from + std::ptrdiff_t(length));
    if (kind == 4) std::fill_n(from, std::min<std::size_t>(length, 40), std::uint8_t(0));
  }
  return first;
}

bool same_plane(const fba::Plane& a, const fba::Plane& b) {
  const bool bodies = (a.body == nullptr) == (b.body == nullptr);
  return a.number == b.number && a.intra == b.intra && a.object_mask == b.object_mask &&
         a.face == b.face && bodies && (a.body == nullptr || a.body->value == b.body->value);
}

// Streams of any encoder: without start codes, with start codes inside of planes, with face and
// body in turn, with intra planes that send no ranges.
TEST(Repair, WhatIsWrittenDecodesWithAllThatIsBeforeTheDamage) {
  const auto streams = test::reference_streams();
  ASSERT_FALSE(streams.empty());
  std::size_t damaged = 0, lost = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    test::Random random(seed);
    const auto& base = streams[random.next() % streams.size()];
    Bytes stream = test::read_bytes(base.string() + ".fba");
    if (stream.size() < 32 || stream.size() > 40000) continue;
    const std::size_t first = hurt(stream, random);
    const auto repaired = fba::repair_stream(stream);
    // Fewer than 16 bits behind a plane may count for it.
    const auto whole = planes_before(stream, std::int64_t(first) * 8 - 16);
    if (!repaired) {
      lost += whole.size() > 1;
      continue;
    }
    const auto decoded = fba::decode(repaired->stream);
    ASSERT_TRUE(decoded) << seed << " " << base << ": " << decoded.error().describe();
    if (repaired->damage.empty()) continue;
    ++damaged;
    // The last one may have to go, since where it ends is told by the damaged one.
    ASSERT_GE(decoded->planes.size() + 1, whole.size()) << seed << " " << base;
    for (std::size_t i = 0; i + 1 < whole.size(); ++i) {
      ASSERT_TRUE(same_plane(whole[i], decoded->planes[i])) << seed << " " << base << " " << i;
    }
    auto units = fba::split_access_units(repaired->stream);
    ASSERT_TRUE(units) << seed << " " << base;
    const auto before = *units;
    const auto again = fba::repair_units(*units);
    ASSERT_TRUE(again) << seed << " " << base;
    EXPECT_EQ(again->empty(), *units == before);
  }
  EXPECT_GT(damaged, 600u);
  EXPECT_EQ(lost, 0u);
}

TEST(Repair, NothingLeftIsAnError) {
  EXPECT_EQ(fba::repair_stream({}).error().code, Code::truncated);
  const Bytes noise(500, 0x5A);
  EXPECT_FALSE(fba::repair_stream(noise));
  fba::AccessUnits units = units_of_clip(6);
  units.units.erase(units.units.begin());
  units.units.resize(4);
  EXPECT_FALSE(fba::repair_units(units));
}

}  // namespace repair_test
}  // namespace animeme
