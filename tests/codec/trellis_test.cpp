// The search for levels, and the code lengths it goes by.
#include "codec/encode/trellis_internal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "codec/encode/clip_internal.h"
#include "codec/encode/encode.h"
#include "tests/support/random_clip.h"

namespace animeme {
namespace trellis_test {

using fba::internal::kOneBit;
using fba::internal::TrellisProblem;
using fba::internal::TrellisResult;

std::vector<std::int32_t> wave(std::uint64_t seed, int size, int count) {
  test::Random random(seed);
  std::vector<std::int32_t> row;
  for (int i = 0; i < count; ++i) {
    row.push_back(int(std::lround(size * std::sin(0.15 * i))) + random.range(-3, 3));
  }
  return row;
}

TEST(CodeLength, IsWhatTheCoderTakes) {
  // One FAP over 400 planes: the stream has known bits besides.
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto row = wave(seed, 300, 400);
    fap::Sequence clip;
    for (std::size_t i = 0; i < row.size(); ++i) {
      fap::Frame frame;
      frame.number = std::int64_t(i);
      frame.set(5, row[i]);
      clip.frames.push_back(frame);
    }
    std::vector<std::int32_t> levels;
    fba::internal::quantise_row(row, fap::info(5).quant_step, levels);
    const fba::internal::RunCost cost = fba::internal::run_cost(levels, 1);
    ASSERT_TRUE(cost.fits);
    const double bits = double(cost.bits) / double(kOneBit);
    // Start and end codes, the intra header, and 5 bits per plane: 4 of its header, and 1 that the
    // end of a segment takes more than the symbols are worth.
    const double others = 32 + 120 + 40 + 400 * 5.0;
    const double got = double(fba::encode(clip)->size()) * 8;
    EXPECT_NEAR(got, bits + others, 0.02 * got);
    EXPECT_GT(bits, 400 * 4);
  }
}

TEST(CodeLength, OfAConstantRowIsTheRangesAlone) {
  const std::vector<std::int32_t> levels(50, 0);
  EXPECT_EQ(fba::internal::run_cost(levels, 1).bits, 20 * kOneBit);
}

TEST(CodeLength, TellsWhatDoesNotFit) {
  EXPECT_FALSE(fba::internal::run_cost(std::vector<std::int32_t>{0, 1861}, 1).fits);
  EXPECT_TRUE(fba::internal::run_cost(std::vector<std::int32_t>{0, 1860}, 1).fits);
  EXPECT_FALSE(fba::internal::run_cost(std::vector<std::int32_t>{INT32_MIN, INT32_MAX}, 1).fits);
}

class Trellis : public testing::TestWithParam<int> {};

TEST_P(Trellis, IsNeverWorseThanThePlainQuantiser) {
  const auto a = wave(std::uint64_t(GetParam()), 200, 150);
  const auto b = wave(std::uint64_t(GetParam()) + 100, 195, 150);
  const std::vector<std::size_t> runs = {0, 60, 61};
  for (const bool pair : {false, true}) {
    TrellisProblem problem;
    problem.a = a;
    if (pair) problem.b = b;
    problem.scale = 1 + GetParam() % 6;
    problem.step = 2 * problem.scale;
    problem.run_begin = runs;
    const TrellisResult plain = fba::internal::plain_row(problem);
    double bits_before = double(plain.bits);
    for (const double lambda : {0.5, 4.0, 30.0}) {
      const TrellisResult found = fba::internal::search_row(problem, lambda, plain);
      EXPECT_TRUE(found.fits);
      EXPECT_LE(cost_of(found, lambda), cost_of(plain, lambda));
      EXPECT_LE(double(found.bits), bits_before);
      bits_before = double(found.bits);
      // What it says of its levels is so.
      double error = 0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        const double rec = double(found.levels[i]) * problem.step;
        error += (a[i] - rec) * (a[i] - rec);
        if (pair) error += (b[i] - rec) * (b[i] - rec);
      }
      EXPECT_NEAR(found.error, error, 1e-6);
    }
  }
}

TEST_P(Trellis, FindsTheBestOfAShortRow) {
  // All rows near the values, against the search: it must come close to the best of them.
  test::Random random(std::uint64_t(GetParam()) + 7);
  std::vector<std::int32_t> values;
  for (int i = 0; i < 6; ++i) values.push_back(random.range(-20, 20));
  const std::vector<std::size_t> runs = {0};
  TrellisProblem problem;
  problem.a = values;
  problem.step = 8;
  problem.scale = 4;
  problem.run_begin = runs;
  const double lambda = 20;
  double best = 1e30;
  for (int code = 0; code < 15625; ++code) {
    std::vector<std::int32_t> levels;
    double error = 0;
    for (int i = 0, rest = code; i < 6; ++i, rest /= 5) {
      levels.push_back(int(std::lround(values[std::size_t(i)] / 8.0)) + rest % 5 - 2);
      const double e = values[std::size_t(i)] - levels.back() * 8.0;
      error += e * e;
    }
    const auto cost = fba::internal::run_cost(levels, 4);
    best = std::min(best, error + lambda * double(cost.bits) / double(kOneBit));
  }
  TrellisResult found =
      fba::internal::search_row(problem, lambda, fba::internal::plain_row(problem));
  const TrellisResult still = fba::internal::still_row(problem);
  if (cost_of(still, lambda) < cost_of(found, lambda)) found = still;
  EXPECT_GE(cost_of(found, lambda), best - 1e-6);
  EXPECT_LE(cost_of(found, lambda), best * 1.12);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Trellis, testing::Range(1, 13));

}  // namespace trellis_test
}  // namespace animeme
