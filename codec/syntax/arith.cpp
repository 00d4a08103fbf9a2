#include "codec/syntax/arith.h"

#include <bit>

namespace animeme::fba {

namespace {

constexpr std::uint32_t kQuarter1 = 16384;

// Register values after a symbol, and what is shifted out of them.
struct Narrowed {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t bits;  // the leading bits that low and high shared
  int shared;          // their number
  int straddling;      // bits behind the first different one in which low is 1 and high is 0
};

inline Narrowed narrow(std::uint32_t low, std::uint32_t high, const SymbolInterval& symbol) {
  // length * count / total by a reciprocal that is too large by at most 2 / 2^46 parts of one:
  // exact, since length * count is at most 2^16 * total and total is below 2^14.
  const std::uint64_t reciprocal = std::uint64_t(std::int64_t(0x1p46 / double(symbol.total))) + 1;
  const std::uint64_t length = high - low + 1;
  high = low + std::uint32_t((length * symbol.high * reciprocal) >> 46) - 1;
  low = low + std::uint32_t((length * symbol.low * reciprocal) >> 46);
  // The registers have 16 bits; the 1 behind them stops the count.
  const int shared = std::countl_zero(((low ^ high) << 16) | 0x8000U);
  const int straddling = std::countl_one((low & ~high) << shared << 17);
  const int shift = shared + straddling;
  Narrowed next;
  next.bits = low >> (16 - shared);
  next.low = (low << shift) & 0x7FFFU;
  next.high = ((((high + 1) << shift) - 1) & 0xFFFFU) | 0x8000U;
  next.shared = shared;
  next.straddling = straddling;
  return next;
}

}  // namespace

void SegmentEncoder::encode(const SymbolInterval& symbol) {
  const Narrowed next = narrow(low_, high_, symbol);
  if (next.shared != 0) emit(next.bits, next.shared);
  pending_ += std::uint32_t(next.straddling);
  low_ = next.low;
  high_ = next.high;
}

void SegmentEncoder::flush() {
  ++pending_;
  emit(low_ < kQuarter1 ? 0 : 1, 1);
  low_ = 0;
  high_ = 0xFFFF;
  zeros_ = 0;
}

// The first of the bits is followed by the pending ones, which are its opposite.
void SegmentEncoder::emit(std::uint32_t bits, int count) {
  const std::uint32_t first = bits >> (count - 1);
  const std::uint32_t rest = bits & ((1U << (count - 1)) - 1);
  if (pending_ + std::uint32_t(count) <= kStuffingRun) {
    const std::uint32_t head = first != 0 ? 1U << pending_ : (1U << pending_) - 1;
    put(head << (count - 1) | rest, int(pending_) + count);
  } else {
    put(first, 1);
    for (; pending_ != 0; --pending_) put(first ^ 1U, 1);
    if (count > 1) put(rest, count - 1);
  }
  pending_ = 0;
}

// 1 to 22 code bits: so few that a run of 22 zeros can only be completed at their front, or by
// all of them.
void SegmentEncoder::put(std::uint32_t bits, int count) {
  const int leading = count - int(std::bit_width(bits));
  if (zeros_ + leading < kStuffingRun || (bits == 0 && zeros_ + count == kStuffingRun)) {
    out_.bits(bits, count);
    zeros_ = bits == 0 ? zeros_ + count : std::countr_zero(bits);
    return;
  }
  for (int i = count - 1; i >= 0; --i) {
    if (zeros_ == kStuffingRun) {
      out_.bit(1);
      zeros_ = 0;
    }
    const std::uint32_t bit = (bits >> i) & 1U;
    out_.bit(bit);
    zeros_ = bit != 0 ? 0 : zeros_ + 1;
  }
}

bool SegmentDecoder::consume(const SymbolInterval& symbol) {
  const Narrowed next = narrow(low_, high_, symbol);
  const int shift = next.shared + next.straddling;
  if (shift > ahead_bits_) return false;
  low_ = next.low;
  high_ = next.high;
  // Of the shared bits nothing stays; straddling leaves the first bit and drops those behind it.
  const std::uint32_t wide = (value_ << shift) | take(shift);
  value_ = (wide & 0x7FFFU) | ((wide >> next.straddling) & 0x8000U);
  if (ahead_bits_ < 16) fill();
  return true;
}

void SegmentDecoder::open_window() {
  if (ahead_bits_ >= 16) value_ = take(16);
}

// Up to 16 bits from the front of those ahead.
std::uint32_t SegmentDecoder::take(int count) {
  const std::uint32_t bits = std::uint32_t((ahead_ >> 1) >> (63 - count));
  ahead_ <<= count;
  ahead_bits_ -= count;
  taken_ += std::size_t(count);
  return bits;
}

void SegmentDecoder::fill() {
  while (ahead_bits_ <= 32) {
    const std::uint32_t bits = in_.peek32();
    // Without 22 zeros in a row there is no stuffed bit: such a run within 32 bits would cover
    // the middle twelve.
    if (in_.position() + 32 <= in_.size() && (bits & 0x003FFC00U) != 0 &&
        zeros_ + std::countl_zero(bits) < kStuffingRun) {
      ahead_ |= std::uint64_t(bits) << (32 - ahead_bits_);
      ahead_bits_ += 32;
      zeros_ = std::countr_zero(bits);
      in_.seek(in_.position() + 32);
    } else if (!fill_bit_by_bit()) {
      return;
    }
  }
}

// 32 bits; false if they do not suffice.
bool SegmentDecoder::fill_bit_by_bit() {
  for (int i = 0; i < 32; ++i) {
    if (zeros_ == kStuffingRun) {
      if (!last_ && in_.position() >= in_.size()) return false;
      if (in_.bit() == 0 && bad_stuffing_ == SIZE_MAX) bad_stuffing_ = in_.position() - 1;
      stuffed_at_[stuffed_ % stuffed_at_.size()] = taken_ + std::size_t(ahead_bits_);
      ++stuffed_;
      zeros_ = 0;
    }
    if (!last_ && in_.position() >= in_.size()) return false;
    const std::uint32_t bit = in_.bit();
    ahead_ |= std::uint64_t(bit) << (63 - ahead_bits_);
    ++ahead_bits_;
    zeros_ = bit != 0 ? 0 : zeros_ + 1;
  }
  return true;
}

// Where in the stream the first so many code bits end: each is one bit, and one more for each
// stuffed bit before or among them.
std::size_t SegmentDecoder::position_behind(std::size_t bits) const {
  std::size_t position = begin_ + bits + stuffed_;
  for (const std::size_t at : stuffed_at_) {
    if (at >= bits) --position;
  }
  return position;
}

}  // namespace animeme::fba
