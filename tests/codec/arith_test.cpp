// The fast arithmetic coder against the textbook one: the same bits, the same symbols, the same
// ends of segments, whatever the models and symbols are.
#include <gtest/gtest.h>

#include <algorithm>

#include "codec/syntax/arith.h"
#include "tests/bench/textbook_coder.h"
#include "tests/support/random_clip.h"

namespace animeme {
namespace arith_test {

using test::Random;

// A stream of segments over a few models that live on from one segment to the next.
struct Material {
  std::vector<int> alphabets;
  struct Symbol {
    std::size_t model;
    int value;
  };
  std::vector<std::vector<Symbol>> segments;
};

// How symbols are chosen: 0 anything, 1 near the middle, 2 the highest (their code is zeros),
// 3 the lowest, 4 one of few.
int choose(Random& random, int kind, int n) {
  switch (kind) {
    case 0:
      return random.range(0, n - 1);
    case 1:
      return std::clamp(n / 2 + random.range(-3, 3) * random.range(0, 2), 0, n - 1);
    case 2:
      return random.chance(97) ? n - 1 : random.range(0, n - 1);
    case 3:
      return random.chance(97) ? 0 : random.range(0, n - 1);
    default:
      return int(std::uint64_t(random.range(0, 4)) * 1237 % std::uint64_t(n));
  }
}

Material material(std::uint64_t seed, int symbols) {
  Random random(seed);
  Material out;
  const int largest[] = {1, 2, 17, 31, 64, 121, 128, 140, 257, 1201, 3721};
  for (const int most : largest) out.alphabets.push_back(random.range((most + 1) / 2, most));
  out.alphabets.back() = 3721;
  std::vector<int> kinds;
  for (std::size_t i = 0; i < out.alphabets.size(); ++i) kinds.push_back(random.range(0, 4));
  for (int count = 0; count < symbols;) {
    std::vector<Material::Symbol> segment;
    const int size = random.chance(10) ? 0 : random.range(1, 90);
    const bool zeros = random.chance(15);  // highest symbols only, whose code is long runs of zeros
    const bool one_model = random.chance(60);
    // One model of each stream is used so often that it is halved.
    const std::size_t fixed = std::size_t(seed % out.alphabets.size());
    for (int i = 0; i < size; ++i, ++count) {
      const std::size_t model =
          one_model ? fixed : std::size_t(random.range(0, int(out.alphabets.size()) - 1));
      segment.push_back({model, choose(random, zeros ? 2 : kinds[model], out.alphabets[model])});
    }
    out.segments.push_back(segment);
  }
  return out;
}

std::vector<fba::AdaptiveModel> fast_models(const Material& material) {
  std::vector<fba::AdaptiveModel> models(material.alphabets.size());
  for (std::size_t i = 0; i < models.size(); ++i) {
    models[i].reset(std::uint32_t(material.alphabets[i]));
  }
  return models;
}

class RandomSymbols : public testing::TestWithParam<int> {};

TEST_P(RandomSymbols, AreCodedWithTheBitsOfTheTextbook) {
  const Material given = material(std::uint64_t(GetParam()), 50000);

  textbook::Bits expected;
  std::vector<textbook::Model> slow;
  for (const int n : given.alphabets) slow.emplace_back(n);
  fba::BitWriter out;
  std::vector<fba::AdaptiveModel> fast = fast_models(given);
  std::vector<std::size_t> ends;
  int stuffed = 0;
  int halvings = 0;
  for (const auto& symbols : given.segments) {
    textbook::SegmentWriter slow_segment(expected);
    fba::SegmentEncoder segment(out);
    for (const auto& [model, value] : symbols) {
      slow_segment.encode(slow[model], value);
      halvings += slow[model].c[0] == 16383 ? 1 : 0;
      slow[model].update(value);
      const fba::SymbolInterval interval = fast[model].interval(std::uint32_t(value));
      segment.encode(interval);
      fast[model].update(std::uint32_t(value));
      ASSERT_EQ(int(fast[model].total()), slow[model].c[0]);
    }
    slow_segment.flush();
    stuffed += slow_segment.stuffed();
    segment.flush();
    ends.push_back(out.position());
    ASSERT_EQ(out.position(), expected.count);
    // Zeros between segments: the reader must not take them for a run of the segment.
    const int zeros = int(symbols.size() % 25);
    for (int i = 0; i < zeros; ++i) expected.put(0);
    out.bits(0, zeros);
  }
  EXPECT_GT(stuffed, 0) << "no zero run was long enough";
  EXPECT_GT(halvings, 0) << "no model was halved";
  const std::size_t padding = 8 - out.position() % 8;
  out.bits(0, int(padding));
  expected.put(0, int(padding));
  const std::vector<std::uint8_t> bytes = out.bytes();
  ASSERT_TRUE(bytes == expected.bytes);

  // Read, once with everything at hand and once in pieces.
  for (const std::size_t piece : {bytes.size(), std::size_t(1), std::size_t(5)}) {
    fast = fast_models(given);
    std::size_t available = piece;
    std::size_t position = 0;
    for (std::size_t s = 0; s < given.segments.size(); ++s) {
      const auto more = [&](fba::SegmentDecoder& segment) {
        ASSERT_LT(available, bytes.size()) << "the bits ran out";
        available = std::min(bytes.size(), available + piece);
        segment.resume(std::span(bytes).first(available), available == bytes.size());
      };
      const std::span<const std::uint8_t> part(bytes.data(), available);
      const fba::BitReader in(part, position);
      fba::SegmentDecoder segment(in, available == bytes.size());
      while (!segment.ready()) ASSERT_NO_FATAL_FAILURE(more(segment));
      for (const auto& [model, value] : given.segments[s]) {
        fba::SymbolInterval interval;
        for (;;) {
          const std::uint32_t symbol =
              fast[model].find(segment.target(fast[model].total()), interval);
          ASSERT_EQ(int(symbol), value);
          const fba::SymbolInterval same = fast[model].interval(symbol);
          ASSERT_EQ(interval.low, same.low);
          ASSERT_EQ(interval.high, same.high);
          if (segment.consume(interval)) break;
          ASSERT_NO_FATAL_FAILURE(more(segment));
        }
        fast[model].update(std::uint32_t(value));
        if (s % 3 != 0) fast[model].expect(std::uint32_t(value));
      }
      ASSERT_EQ(segment.end(), ends[s]);
      ASSERT_EQ(segment.bad_stuffing(), SIZE_MAX);
      position = ends[s] + given.segments[s].size() % 25;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Coder, RandomSymbols, testing::Range(1, 12));

TEST(Coder, AModelIsHalvedAsInTheTextbook) {
  // Every symbol of the largest alphabet, then so many of a few that the total is reached often.
  for (const int n : {1, 15, 16, 17, 61, 127, 128, 129, 256, 257, 3721}) {
    Random random{std::uint64_t(n)};
    textbook::Model slow(n);
    fba::AdaptiveModel fast;
    fast.reset(std::uint32_t(n));
    int halvings = 0;
    const auto count = [&](int symbol) {
      const int before = slow.c[0];
      slow.update(symbol);
      fast.update(std::uint32_t(symbol));
      halvings += slow.c[0] < before ? 1 : 0;
    };
    for (int symbol = 0; symbol < n; symbol += random.range(1, 2)) count(symbol);
    for (int i = 0; i < 40000; ++i) count(choose(random, 4 - i / 20000, n));
    EXPECT_GE(halvings, 3);
    for (int symbol = 0; symbol < n; ++symbol) {
      const fba::SymbolInterval interval = fast.interval(std::uint32_t(symbol));
      ASSERT_EQ(int(interval.low), slow.c[std::size_t(symbol) + 1]);
      ASSERT_EQ(int(interval.high), slow.c[std::size_t(symbol)]);
      ASSERT_EQ(int(interval.total), slow.c[0]);
      for (const std::uint32_t target : {interval.low, interval.high - 1}) {
        fba::SymbolInterval found;
        ASSERT_EQ(int(fast.find(target, found)), symbol);
        ASSERT_EQ(found.low, interval.low);
        ASSERT_EQ(found.high, interval.high);
      }
    }
  }
}

// Shifts one by one, as the description has them.
int shifts_one_by_one(std::int64_t low, std::int64_t high) {
  for (int shifts = 0;; ++shifts) {
    if (low >= textbook::kQ2) {
      low -= textbook::kQ2;
      high -= textbook::kQ2;
    } else if (high >= textbook::kQ2) {
      if (low < textbook::kQ1 || high >= textbook::kQ3) return shifts;
      low -= textbook::kQ1;
      high -= textbook::kQ1;
    }
    low = 2 * low;
    high = 2 * high + 1;
  }
}

TEST(Coder, ShiftsAreCountedAsTheDescriptionDoesThem) {
  // All short intervals, and some of each length around the borders of the registers.
  for (std::uint32_t low = 0; low < 0x10000; ++low) {
    for (std::uint32_t length = 1; length <= 40 && low + length <= 0x10000; ++length) {
      ASSERT_EQ(fba::shifts_of(low, length), shifts_one_by_one(low, low + length - 1))
          << low << ' ' << length;
    }
  }
  Random random(44);
  for (int i = 0; i < 1000000; ++i) {
    const int low = random.chance(50)
                        ? random.range(0, 0xFFFF)
                        : std::clamp(random.range(0, 4) * 0x4000 + random.range(-3, 3), 0, 0xFFFF);
    const int most = 0x10000 - low;
    int length = random.range(1, most);
    if (random.chance(50)) {  // an end at a border
      length = std::clamp(random.range(0, 4) * 0x4000 + random.range(-3, 3) - low, 1, most);
    }
    ASSERT_EQ(fba::shifts_of(std::uint32_t(low), std::uint32_t(length)),
              shifts_one_by_one(low, low + length - 1))
        << low << ' ' << length;
  }
}

TEST(Coder, ACarryGoesThroughBitsThatWaitForIt) {
  // The middle symbol of three straddles the middle of the registers, however often it comes.
  for (int middle = 0; middle < 200; ++middle) {
    for (const int last : {0, 1, 2}) {
      textbook::Bits expected;
      textbook::SegmentWriter slow(expected);
      fba::BitWriter out;
      fba::SegmentEncoder fast(out);
      const auto encode = [&](int symbol) {
        slow.encode(textbook::Model(3), symbol);
        fast.encode(fba::flat_interval(std::uint32_t(symbol), 3));
      };
      for (int i = 0; i < middle; ++i) encode(1);
      encode(last);
      encode(1);
      slow.flush();
      fast.flush();
      ASSERT_EQ(out.position(), expected.count) << middle << ' ' << last;
      const int padding = 8 - int(out.position() % 8);
      out.bits(0, padding);
      expected.put(0, padding);
      ASSERT_TRUE(out.bytes() == expected.bytes) << middle << ' ' << last;
    }
  }
}

TEST(Coder, AMissingStuffedBitIsFoundInsideTheSegmentOnly) {
  // The highest symbol of a flat model is all zeros: 30 of them need a stuffed bit.
  fba::AdaptiveModel model;
  model.reset(2);
  fba::BitWriter out;
  fba::SegmentEncoder segment(out);
  for (int i = 0; i < 30; ++i) segment.encode(fba::flat_interval(1, 2));
  segment.flush();
  const std::size_t end = out.position();
  out.bits(0, 32);
  out.bits(0, 32);
  std::vector<std::uint8_t> bytes = out.bytes();
  ASSERT_EQ(end, 30U + 2U + 1U);
  const auto read = [&bytes] {
    fba::SegmentDecoder reader{fba::BitReader(bytes)};
    for (int i = 0; i < 30; ++i) {
      EXPECT_EQ(1 - reader.target(2), 1U);
      EXPECT_TRUE(reader.consume(fba::flat_interval(1, 2)));
    }
    return reader;
  };
  EXPECT_EQ(read().end(), end);
  EXPECT_EQ(read().bad_stuffing(), SIZE_MAX);  // the zeros that follow are not the segment's
  bytes[22 / 8] &= std::uint8_t(~(0x80 >> (22 % 8)));
  EXPECT_EQ(read().bad_stuffing(), 22U);
}

}  // namespace arith_test
}  // namespace animeme
