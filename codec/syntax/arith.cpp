#include "codec/syntax/arith.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace animeme::fba {

// Takes 32 more bits, which all behind them may still change by a carry, and above them the carry
// into those before.
void SegmentEncoder::add_word(std::uint64_t word) {
  if (waiting_ && word == 0xFFFFFFFFU) {
    ++ones_;
    return;
  }
  settle(std::uint32_t(word >> 32));
  word_ = std::uint32_t(word);
  waiting_ = true;
}

// Nothing but `carry` will change the words so far.
void SegmentEncoder::settle(std::uint32_t carry) {
  if (waiting_) put_word(word_ + carry);
  for (; ones_ != 0; --ones_) put_word(carry != 0 ? 0 : 0xFFFFFFFFU);
  waiting_ = false;
}

// The description writes the bit that says in which half the second quarter of the registers lies,
// and behind it the pending ones and one more, which are its opposite: the first two bits of
// low + 1/4, with its carry.
int SegmentEncoder::flush_any() {
  const std::uint64_t rest = (now_.low + 0x4000U) >> 14;
  const int count = now_.bits + 2;
  now_ = {};
  if (!waiting_ && count <= kStuffingRun) {
    put(std::uint32_t(rest), count);
  } else {
    settle(std::uint32_t(rest >> count));
    const int head = std::max(count - 16, 0);
    if (head > 0) put(std::uint32_t(rest >> 16) & ((1U << head) - 1), head);
    const int tail = count - head;
    put(std::uint32_t(rest) & ((1U << tail) - 1), tail);
  }
  return std::exchange(zeros_, 0);
}

void SegmentEncoder::put_word(std::uint32_t word) {
  // Without 22 zeros in a row nothing is stuffed: such a run within 32 bits would cover the middle
  // twelve.
  if ((word & 0x003FFC00U) != 0 && zeros_ + std::countl_zero(word) < kStuffingRun) {
    out_.bits(word, 32);
    zeros_ = std::countr_zero(word);
    return;
  }
  put(word >> 16, 16);
  put(word & 0xFFFFU, 16);
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

void SegmentDecoder::fill() {
  while (cursor_.ahead_bits_ <= 32) {
    const std::uint32_t bits = in_.peek32();
    // Without 22 zeros in a row there is no stuffed bit: such a run within 32 bits would cover
    // the middle twelve.
    if (in_.position() + 32 <= in_.size() && (bits & 0x003FFC00U) != 0 &&
        zeros_ + std::countl_zero(bits) < kStuffingRun) {
      cursor_.ahead_ |= std::uint64_t(bits) << (32 - cursor_.ahead_bits_);
      cursor_.ahead_bits_ += 32;
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
      stuffed_at_[stuffed_ % stuffed_at_.size()] =
          cursor_.taken_ + std::size_t(cursor_.ahead_bits_);
      ++stuffed_;
      zeros_ = 0;
    }
    if (!last_ && in_.position() >= in_.size()) return false;
    const std::uint32_t bit = in_.bit();
    cursor_.ahead_ |= std::uint64_t(bit) << (63 - cursor_.ahead_bits_);
    ++cursor_.ahead_bits_;
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
