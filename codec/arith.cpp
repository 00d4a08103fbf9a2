#include "codec/arith.h"

#include <algorithm>
#include <bit>

namespace animeme::fba {

namespace {
constexpr std::uint32_t kQuarter1 = 16384;
constexpr std::uint32_t kQuarter2 = 32768;
constexpr std::uint32_t kQuarter3 = 49152;
}  // namespace

SymbolInterval AdaptiveModel::interval(std::uint32_t k) const {
  if (fresh_) return flat_interval(k, n_);
  const std::uint32_t mirrored = n_ - 1 - k;
  return {prefix(mirrored), prefix(mirrored + 1), total_};
}

std::uint32_t AdaptiveModel::find(std::uint32_t target, SymbolInterval& interval) const {
  if (fresh_) {
    interval = {target, target + 1, n_};
    return n_ - 1 - target;
  }
  // Descend: the largest index whose prefix sum does not exceed the target.
  std::uint32_t index = 0;
  std::uint32_t below = 0;
  for (std::uint32_t step = std::bit_floor(n_); step != 0; step >>= 1) {
    const std::uint32_t probe = index + step;
    if (probe <= n_ && below + tree_[probe] <= target) {
      index = probe;
      below += tree_[probe];
    }
  }
  interval = {below, prefix(index + 1), total_};
  return n_ - 1 - index;
}

void AdaptiveModel::update(std::uint32_t k) {
  if (fresh_) build();
  if (total_ >= kMaxTotal) halve();
  for (std::uint32_t i = n_ - k; i <= n_; i += i & (~i + 1)) ++tree_[i];
  ++total_;
}

std::uint32_t AdaptiveModel::prefix(std::uint32_t mirrored) const {
  std::uint32_t sum = 0;
  for (std::uint32_t i = mirrored; i != 0; i &= i - 1) sum += tree_[i];
  return sum;
}

void AdaptiveModel::build() {
  tree_.resize(n_ + 1);
  for (std::uint32_t i = 1; i <= n_; ++i) tree_[i] = std::uint16_t(i & (~i + 1));
  fresh_ = false;
}

void AdaptiveModel::halve() {
  // Back to plain counts, halve (rounding up, so that none becomes 0), and sum up again.
  for (std::uint32_t i = n_; i != 0; --i) {
    const std::uint32_t parent = i + (i & (~i + 1));
    if (parent <= n_) tree_[parent] = std::uint16_t(tree_[parent] - tree_[i]);
  }
  total_ = 0;
  for (std::uint32_t i = 1; i <= n_; ++i) {
    tree_[i] = std::uint16_t((tree_[i] + 1U) / 2U);
    total_ += tree_[i];
  }
  for (std::uint32_t i = 1; i <= n_; ++i) {
    const std::uint32_t parent = i + (i & (~i + 1));
    if (parent <= n_) tree_[parent] = std::uint16_t(tree_[parent] + tree_[i]);
  }
}

void SegmentEncoder::encode(const SymbolInterval& symbol) {
  // Products stay below 65536 * 16383 < 2^31.
  const std::uint32_t length = high_ - low_ + 1;
  high_ = low_ + length * symbol.high / symbol.total - 1;
  low_ = low_ + length * symbol.low / symbol.total;
  for (;;) {
    if (high_ < kQuarter2) {
      emit(0);
    } else if (low_ >= kQuarter2) {
      emit(1);
      low_ -= kQuarter2;
      high_ -= kQuarter2;
    } else if (low_ >= kQuarter1 && high_ < kQuarter3) {
      ++pending_;
      low_ -= kQuarter1;
      high_ -= kQuarter1;
    } else {
      return;
    }
    low_ = 2 * low_;
    high_ = 2 * high_ + 1;
  }
}

void SegmentEncoder::flush() {
  ++pending_;
  emit(low_ < kQuarter1 ? 0 : 1);
  low_ = 0;
  high_ = 0xFFFF;
  zeros_ = 0;
}

void SegmentEncoder::emit(std::uint32_t bit) {
  put(bit);
  for (; pending_ != 0; --pending_) put(bit ^ 1U);
}

void SegmentEncoder::put(std::uint32_t bit) {
  if (zeros_ == kStuffingRun) {
    out_.bit(1);
    zeros_ = 0;
  }
  out_.bit(bit);
  zeros_ = bit != 0 ? 0 : zeros_ + 1;
}

SegmentDecoder::SegmentDecoder(const BitReader& in) : in_(in) {
  for (std::size_t i = 0; i < 16; ++i) {
    value_ = (value_ << 1) | next_bit();
    positions_[i] = in_.position();
  }
}

void SegmentDecoder::consume(const SymbolInterval& symbol) {
  const std::uint32_t length = high_ - low_ + 1;
  high_ = low_ + length * symbol.high / symbol.total - 1;
  low_ = low_ + length * symbol.low / symbol.total;
  for (;;) {
    std::uint32_t offset = 0;
    if (high_ < kQuarter2) {
      offset = 0;
    } else if (low_ >= kQuarter2) {
      offset = kQuarter2;
    } else if (low_ >= kQuarter1 && high_ < kQuarter3) {
      offset = kQuarter1;
    } else {
      return;
    }
    low_ = 2 * (low_ - offset);
    high_ = 2 * (high_ - offset) + 1;
    value_ = 2 * (value_ - offset) + next_bit();
    positions_[next_] = in_.position();
    next_ = (next_ + 1) & 15;
  }
}

std::uint32_t SegmentDecoder::next_bit() {
  if (zeros_ == kStuffingRun) {
    if (in_.bit() == 0 && bad_stuffing_ == SIZE_MAX) bad_stuffing_ = in_.position() - 1;
    zeros_ = 0;
  }
  const std::uint32_t bit = in_.bit();
  zeros_ = bit != 0 ? 0 : zeros_ + 1;
  return bit;
}

}  // namespace animeme::fba
