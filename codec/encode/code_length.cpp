#include <algorithm>
#include <cmath>

#include "codec/encode/code_length_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

constexpr std::uint32_t kTableSize = 1U << 15;
constexpr double kLn2 = 0.693147180559945309417;

struct Tables {
  std::vector<Bits> log2 = std::vector<Bits>(kTableSize);
  std::vector<Bits> factorial = std::vector<Bits>(kTableSize);

  Tables() {
    // Rounded to 1/65536 bit, so that the last digit of the library's log2 does not matter.
    for (std::uint32_t n = 1; n < kTableSize; ++n) {
      log2[n] = std::llround(std::log2(double(n)) * double(kOneBit));
      factorial[n] = factorial[n - 1] + log2[n];
    }
  }
};

const Tables& tables() {
  static const Tables made;
  return made;
}

}  // namespace

Bits log2_of(std::uint32_t n) {
  if (n < kTableSize) return tables().log2[n];
  return std::llround(std::log2(double(n)) * double(kOneBit));
}

Bits log2_factorial(std::uint32_t n) {
  if (n < kTableSize) return tables().factorial[n];
  return std::llround(std::lgamma(double(n) + 1) / kLn2 * double(kOneBit));
}

void Histogram::count(std::span<const std::int32_t> levels, std::int32_t low, std::int32_t high) {
  low_ = low;
  total_ = std::uint32_t(levels.size()) - 1;
  count_.assign(std::size_t(high - low + 1), 0);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const std::int32_t change = levels[i] - levels[i - 1];
    if (change >= low && change <= high) ++count_[std::size_t(change - low)];
  }
}

Bits Histogram::bits(std::uint32_t n) const {
  Bits bits = log2_factorial(n - 1 + total_) - log2_factorial(n - 1);
  for (const std::uint32_t count : count_) {
    if (count > 1) bits -= log2_factorial(count);
  }
  return bits;
}

RunCost run_ranges(std::span<const std::int32_t> levels, int scale) {
  std::int64_t low = 0;
  std::int64_t high = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const std::int64_t change = std::int64_t(levels[i]) - levels[i - 1];
    low = std::min(low, change);
    high = std::max(high, change);
  }
  const std::int64_t first = levels.front();
  const int numbers[4] = {range_number(std::max<std::int64_t>(first, 0), scale),
                          range_number(std::max<std::int64_t>(-first, 0), scale),
                          range_number(high, scale), range_number(-low, scale)};
  RunCost cost;
  for (std::size_t kind = 0; kind < 4; ++kind) {
    cost.fits &= numbers[kind] <= kMaxRange;
    cost.range[kind] = std::uint8_t(std::min(numbers[kind], kMaxRange));
  }
  return cost;
}

RunCost run_cost(std::span<const std::int32_t> levels, int scale) {
  RunCost cost = run_ranges(levels, scale);
  if (!cost.fits) return cost;
  const auto reach = [&](RangeKind kind) { return level_range(cost.range[kind], scale); };
  const std::uint32_t intra = std::uint32_t(reach(kIntraMax) + reach(kIntraMin) + 1);
  cost.bits = 20 * kOneBit + log2_of(intra);
  thread_local Histogram histogram;
  histogram.count(levels, -reach(kPredictiveMin), reach(kPredictiveMax));
  cost.bits += histogram.bits(std::uint32_t(reach(kPredictiveMax) + reach(kPredictiveMin) + 1));
  return cost;
}

}  // namespace animeme::fba::internal
