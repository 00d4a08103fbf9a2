#include "codec/adaptive_model.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace animeme::fba {

namespace {

constexpr std::uint32_t kFan = 16;                     // children of a node
constexpr std::uint32_t kFan2 = kFan * kFan;           // symbols below a node of the top level
constexpr std::int16_t kNever = 16384;                 // > any target, also after all updates
constexpr std::uint64_t kLanes = 0x0001000100010001U;  // 1 in each of four 16-bit lanes
constexpr std::uint64_t kTopBits = 0x8000800080008000U;

// Four bytes, first to the lowest lane, whatever the byte order of the machine.
std::uint64_t load4(const std::uint8_t* bytes) {
  std::uint64_t x = std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8 |
                    std::uint32_t(bytes[2]) << 16 | std::uint32_t(bytes[3]) << 24;
  x = (x | (x << 16)) & 0x0000FFFF0000FFFFU;
  return (x | (x << 8)) & 0x00FF00FF00FF00FFU;
}

// Index of the last of 16 ascending sums that is not above the target; sums[0] is 0.
std::uint32_t last_not_above(const std::int16_t* sums, std::uint32_t target) {
  const std::int16_t limit = std::int16_t(target);
  std::int16_t count = 0;
  for (std::uint32_t i = 0; i < kFan; ++i) count = std::int16_t(count + (sums[i] <= limit ? 1 : 0));
  return std::uint32_t(count) - 1;
}

// One more occurrence below child `index`.
void add_above(std::int16_t* sums, std::uint32_t index) {
  const std::int16_t at = std::int16_t(index);
  for (std::int16_t i = 0; i < std::int16_t(kFan); ++i) {
    sums[i] = std::int16_t(sums[i] + (i > at ? 1 : 0));
  }
}

}  // namespace

SymbolInterval AdaptiveModel::interval(std::uint32_t k) const {
  if (fresh_) return flat_interval(k, n_);
  const std::uint32_t mirrored = n_ - 1 - k;
  const std::uint32_t group = mirrored / kFan;
  const std::uint32_t place = mirrored % kFan;
  std::uint32_t low =
      std::uint32_t(below_[mirrored / kFan2]) + std::uint32_t(below_[kFan + group]) + place;
  const std::uint8_t* symbols = &excess_[group * kFan];
  // The lanes below `place` of the sixteen.
  std::uint64_t sum = 0;
  for (std::uint32_t word = 0; word < 4; ++word) {
    const std::uint32_t lanes = std::min(std::max(place, 4 * word) - 4 * word, 4U);
    const std::uint64_t mask =
        lanes == 4 ? ~std::uint64_t(0) : (std::uint64_t(1) << 16 * lanes) - 1;
    sum += load4(symbols + std::size_t(4) * word) & mask;
  }
  low += std::uint32_t((sum * kLanes) >> 48);
  std::uint32_t count = symbols[place] + 1U;
  if (may_overflow(group)) {
    for (const Overflow& entry : overflow_) {
      if (entry.symbol / kFan != group) continue;
      if (entry.symbol < mirrored) low += entry.excess;
      if (entry.symbol == mirrored) count += entry.excess;
    }
  }
  return {low, low + count, total_};
}

std::uint32_t AdaptiveModel::find(std::uint32_t target, SymbolInterval& interval) const {
  if (fresh_) {
    interval = {target, target + 1, n_};
    return n_ - 1 - target;
  }
  const std::uint32_t top = n_ > kFan2 ? last_not_above(below_.data(), target) : 0;
  std::uint32_t base = std::uint32_t(below_[top]);
  const std::int16_t* sums = &below_[kFan + top * kFan];
  const std::uint32_t middle = last_not_above(sums, target - base);
  base += std::uint32_t(sums[middle]);
  const std::uint32_t group = top * kFan + middle;

  // Four words of four frequencies each; multiplying by kLanes gives the running sums.
  std::array<std::uint64_t, 4> word;
  for (std::size_t i = 0; i < 4; ++i) word[i] = load4(&excess_[group * kFan + 4 * i]) + kLanes;
  if (may_overflow(group)) {
    for (const Overflow& entry : overflow_) {
      if (entry.symbol / kFan != group) continue;
      word[entry.symbol % kFan / 4] += std::uint64_t(entry.excess) << 16 * (entry.symbol % 4);
    }
  }
  std::array<std::uint32_t, 4> before;
  std::uint32_t sum = base;
  for (std::size_t i = 0; i < 4; ++i) {
    word[i] *= kLanes;
    before[i] = sum;
    sum += std::uint32_t(word[i] >> 48);
  }
  const std::uint32_t w = std::uint32_t(target >= before[1]) + std::uint32_t(target >= before[2]) +
                          std::uint32_t(target >= before[3]);
  const std::uint64_t sums4 = word[w];
  const std::uint64_t rest = target - before[w];
  // A lane keeps its top bit where the running sum is not above the rest. The last lane of the
  // word always is, the others count.
  const std::uint64_t not_above = (((rest * kLanes) | kTopBits) - sums4) & kTopBits;
  const std::uint32_t lane = std::uint32_t(((not_above >> 15) * kLanes) >> 48);
  interval = {before[w] + (std::uint32_t((sums4 << 16) >> 16 * lane) & 0xFFFFU),
              before[w] + (std::uint32_t(sums4 >> 16 * lane) & 0xFFFFU), total_};
  return n_ - 1 - (group * kFan + 4 * w + lane);
}

void AdaptiveModel::update(std::uint32_t k) {
  if (fresh_) build();
  if (total_ >= kMaxTotal) halve();
  const std::uint32_t mirrored = n_ - 1 - k;
  const std::uint32_t top = mirrored / kFan2;
  if (n_ > kFan2) add_above(below_.data(), top);
  add_above(&below_[kFan + top * kFan], mirrored / kFan % kFan);
  if (++excess_[mirrored] == 0) carry(mirrored);
  ++total_;
}

void AdaptiveModel::carry(std::uint32_t mirrored) {
  for (Overflow& entry : overflow_) {
    if (entry.symbol != mirrored) continue;
    entry.excess = std::uint16_t(entry.excess + 256);
    return;
  }
  overflow_.push_back({std::uint16_t(mirrored), 256});
  overflowing_ |= std::uint64_t(1) << (mirrored / kFan & 63);
}

void AdaptiveModel::build() {
  const std::uint32_t groups = (n_ + kFan - 1) / kFan;
  const std::uint32_t tops = (groups + kFan - 1) / kFan;
  excess_.assign(std::size_t(groups) * kFan, 0);
  below_.resize(std::size_t(kFan) * (1 + tops));
  overflow_.clear();
  overflowing_ = 0;
  fresh_ = false;
  sum_up();
}

void AdaptiveModel::halve() {
  // (f + 1) / 2 of a frequency f is half of the excess f - 1, rounded down, plus 1.
  for (Overflow& entry : overflow_) {
    entry.excess = std::uint16_t((entry.excess + excess_[entry.symbol]) / 2);
  }
  for (std::uint8_t& excess : excess_) excess = std::uint8_t(excess / 2);
  overflowing_ = 0;
  for (Overflow& entry : overflow_) {
    excess_[entry.symbol] = std::uint8_t(entry.excess & 255);
    entry.excess = std::uint16_t(entry.excess & ~255);
    if (entry.excess != 0) overflowing_ |= std::uint64_t(1) << (entry.symbol / kFan & 63);
  }
  std::erase_if(overflow_, [](const Overflow& entry) { return entry.excess == 0; });
  sum_up();
}

// The sums and the total from the frequencies.
void AdaptiveModel::sum_up() {
  std::array<std::uint32_t, kFan2> group_sum{};
  const std::size_t groups = excess_.size() / kFan;
  total_ = n_;
  for (std::size_t group = 0; group < groups; ++group) {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < kFan; ++i) sum += excess_[group * kFan + i];
    group_sum[group] = sum;
  }
  for (const Overflow& entry : overflow_) group_sum[entry.symbol / kFan] += entry.excess;

  std::fill(below_.begin(), below_.end(), kNever);
  std::uint32_t below_top = 0;
  for (std::size_t top = 0; top * kFan < groups; ++top) {
    below_[top] = std::int16_t(below_top);
    std::uint32_t sum = 0;
    for (std::size_t group = top * kFan; group < std::min(groups, (top + 1) * kFan); ++group) {
      below_[kFan + group] = std::int16_t(sum);
      sum += kFan + group_sum[group];
      total_ += group_sum[group];
    }
    below_top += sum;
  }
}

}  // namespace animeme::fba
