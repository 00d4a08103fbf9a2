#include "codec/syntax/adaptive_model.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace animeme::fba {

namespace {

constexpr std::uint32_t kFan = 16;                     // children of a node
constexpr std::uint32_t kFan2 = kFan * kFan;           // symbols below a node of the top level
constexpr std::int16_t kNever = 16384;                 // > any target, also after all updates
constexpr std::uint64_t kLanes = 0x0001000100010001U;  // 1 in each of four 16-bit lanes
constexpr std::uint64_t kTopBits = 0x8000800080008000U;

constexpr std::uint64_t kLowBytes = 0x00FF00FF00FF00FFU;

// Eight bytes, the first one lowest.
std::uint64_t load8(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(&value, bytes, sizeof value);
  } else {
    for (int i = 7; i >= 0; --i) value = (value << 8) | bytes[i];
  }
  return value;
}

// Lane 0..3 of four.
std::uint32_t lane_of(std::uint64_t lanes, std::uint32_t lane) {
  return std::uint32_t(lanes >> (16 * lane)) & 0xFFFFU;
}

// Eight frequencies as two by four lanes: those at even and at odd places, less 1.
struct Eight {
  std::uint64_t even;
  std::uint64_t odd;

  explicit Eight(const std::uint8_t* bytes) {
    const std::uint64_t all = load8(bytes);
    even = all & kLowBytes;
    odd = (all >> 8) & kLowBytes;
  }
  void add(std::uint32_t place, std::uint64_t excess) {
    (place % 2 == 0 ? even : odd) += excess << (16 * (place / 2));
  }
  // Lane i: the frequencies of the first i + 1 pairs.
  std::uint64_t running_sums() const { return (even + odd + 2 * kLanes) * kLanes; }
};

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

constinit const std::array<std::int16_t, 2 * AdaptiveModel::kLine> AdaptiveModel::kMore = [] {
  std::array<std::int16_t, 2 * kLine> more{};
  for (std::size_t i = kLine; i < more.size(); ++i) more[i] = 1;
  return more;
}();

SymbolInterval AdaptiveModel::interval_otherwise(std::uint32_t k) const {
  if (table_ == Table::none) return flat_interval(k, n_);
  const std::uint32_t mirrored = n_ - 1 - k;
  const std::uint32_t group = mirrored / kFan;
  const std::uint32_t place = mirrored % kFan;
  std::uint32_t low =
      std::uint32_t(below_[mirrored / kFan2]) + std::uint32_t(below_[kFan + group]) + place;
  const std::uint8_t* symbols = &excess_[std::size_t(group) * kFan];
  // The bytes before `place` of the sixteen.
  const std::uint64_t first =
      load8(symbols) & (place < 8 ? (std::uint64_t(1) << 8 * place) - 1 : ~0ULL);
  const std::uint64_t second =
      load8(symbols + 8) & (place < 8 ? 0 : (std::uint64_t(1) << 8 * (place - 8)) - 1);
  const std::uint64_t pairs = (first & kLowBytes) + ((first >> 8) & kLowBytes) +
                              (second & kLowBytes) + ((second >> 8) & kLowBytes);
  low += std::uint32_t((pairs * kLanes) >> 48);
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

std::uint32_t AdaptiveModel::find_otherwise(std::uint32_t target, SymbolInterval& interval) const {
  if (table_ == Table::none) {
    interval = {target, target + 1, n_};
    return n_ - 1 - target;
  }
  // Most symbols lie near the one before. So look there first: mostly right, so that the processor
  // need not wait for a search.
  std::uint32_t group = last_group_;
  std::uint32_t top = group / kFan;
  std::uint32_t base = std::uint32_t(below_[top] + below_[kFan + group]);
  const std::uint32_t above = group % kFan == kFan - 1
                                  ? std::uint32_t(below_[top + 1])
                                  : std::uint32_t(below_[top] + below_[kFan + group + 1]);
  if (target < base || target >= above) {
    if (target < std::uint32_t(below_[top]) || target >= std::uint32_t(below_[top + 1])) {
      top = last_not_above(below_.data(), target);
    }
    const std::int16_t* sums = &below_[kFan + top * kFan];
    const std::uint32_t middle = last_not_above(sums, target - std::uint32_t(below_[top]));
    base = std::uint32_t(below_[top] + sums[middle]);
    group = top * kFan + middle;
  }
  const std::uint8_t* symbols = &excess_[std::size_t(group) * kFan];
  Eight eight(symbols);
  Eight upper(symbols + 8);
  if (may_overflow(group)) {
    for (const Overflow& entry : overflow_) {
      if (entry.symbol / kFan != group) continue;
      (entry.symbol % kFan < 8 ? eight : upper).add(entry.symbol % 8, entry.excess);
    }
  }
  // Which half of the group, which pair of the half, which of the pair? No branches: no
  // processor could foretell them.
  const std::uint64_t lower_sums = eight.running_sums();
  const std::uint32_t lower_sum = lane_of(lower_sums, 3);
  const std::uint32_t in_upper = target - base >= lower_sum ? 1 : 0;
  const std::uint64_t choice = std::uint64_t(0) - in_upper;
  base += lower_sum & std::uint32_t(choice);
  eight.even ^= (eight.even ^ upper.even) & choice;
  eight.odd ^= (eight.odd ^ upper.odd) & choice;
  const std::uint64_t sums8 = lower_sums ^ ((lower_sums ^ upper.running_sums()) & choice);
  const std::uint64_t rest = target - base;
  // A lane keeps its top bit where the running sum is not above the rest.
  const std::uint64_t not_above = (((rest * kLanes) | kTopBits) - sums8) & kTopBits;
  const std::uint32_t pair = std::uint32_t(((not_above >> 15) * kLanes) >> 48);
  base += lane_of(sums8 << 16, pair);
  const std::uint32_t even = lane_of(eight.even, pair) + 1;
  const std::uint32_t odd = lane_of(eight.odd, pair) + 1;
  const bool is_odd = target - base >= even;
  const std::uint32_t low = is_odd ? base + even : base;
  interval = {low, low + (is_odd ? odd : even), total_};
  return n_ - 1 - (group * kFan + 8 * in_upper + 2 * pair + (is_odd ? 1 : 0));
}

// Of a line of sums, the last that is not above the target.
std::uint32_t AdaptiveModel::last_of_all(std::uint32_t target) const {
  const std::int16_t limit = std::int16_t(target);
  std::int16_t count = 0;
  for (const std::int16_t sum : below_) count = std::int16_t(count + (sum <= limit ? 1 : 0));
  return std::uint32_t(count) - 1;
}

void AdaptiveModel::update_otherwise(std::uint32_t k) {
  if (table_ == Table::none) build();
  if (total_ >= kMaxTotal) halve();
  if (table_ == Table::line) return update(k);
  const std::uint32_t mirrored = n_ - 1 - k;
  const std::uint32_t top = mirrored / kFan2;
  if (n_ > kFan2) add_above(below_.data(), top);
  const std::uint32_t group = mirrored / kFan;
  add_above(&below_[kFan + top * kFan], group % kFan);
  last_group_ = group;
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
  overflow_.clear();
  overflowing_ = 0;
  if (n_ <= kLargestLine) {
    table_ = Table::line;
    near_ = last_ = repeats_ = 0;
    below_.resize((std::max(n_, kNear) + 2 * kBlock) / (2 * kBlock) * (2 * kBlock));
    for (std::size_t i = 0; i < below_.size(); ++i) {
      below_[i] = i <= n_ ? std::int16_t(i) : kNever;
    }
    return;
  }
  table_ = Table::levels;
  const std::uint32_t groups = (n_ + kFan - 1) / kFan;
  const std::uint32_t tops = (groups + kFan - 1) / kFan;
  excess_.assign(std::size_t(groups) * kFan, 0);
  below_.resize(std::size_t(kFan) * (1 + tops));
  last_group_ = 0;
  sum_up();
}

void AdaptiveModel::halve() {
  if (table_ == Table::line) return halve_line();
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

void AdaptiveModel::halve_line() {
  std::int16_t before = 0;  // the sum that was here
  std::int16_t sum = 0;
  for (std::size_t i = 1; i <= n_; ++i) {
    const int frequency = below_[i] - before;
    before = below_[i];
    sum = std::int16_t(sum + (frequency + 1) / 2);
    below_[i] = sum;
  }
  for (std::size_t i = n_ + 1; i < below_.size(); ++i) below_[i] = kNever;
  total_ = std::uint32_t(sum);
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
