#include "conformance/segment_writer.h"

#include <numeric>

namespace animeme::conformance {
namespace {
constexpr std::uint32_t kMaxTotal = 16383;
constexpr std::int64_t kQ1 = 16384, kQ2 = 32768, kQ3 = 49152;
constexpr int kZeros = 22;
}  // namespace

std::vector<std::uint8_t> Bits::bytes() const {
  std::vector<std::uint8_t> out(bit.size() / 8);
  for (std::size_t i = 0; i < out.size() * 8; ++i) {
    out[i / 8] = std::uint8_t(out[i / 8] << 1 | bit[i]);
  }
  return out;
}

void Frequencies::update(std::size_t symbol) {
  if (std::accumulate(count.begin(), count.end(), 0U) == kMaxTotal) {
    for (std::uint32_t& f : count) f = (f + 1) / 2;
    halved = true;
  }
  ++count[symbol];
}

void SegmentWriter::encode(const Frequencies& model, std::size_t symbol) {
  // Higher symbols lie at the low end: c[k+1] counts those above, c[k] adds the symbol itself.
  std::int64_t above = 0, total = 0;
  for (std::size_t k = 0; k < model.count.size(); ++k) {
    total += model.count[k];
    if (k > symbol) above += model.count[k];
  }
  const std::int64_t length = high_ - low_ + 1;
  high_ = low_ - 1 + length * (above + model.count[symbol]) / total;
  low_ = low_ + length * above / total;
  for (;;) {
    if (high_ < kQ2) {
      emit(0);
    } else if (low_ >= kQ2) {
      emit(1);
      low_ -= kQ2;
      high_ -= kQ2;
    } else if (low_ >= kQ1 && high_ < kQ3) {
      ++pending_;
      low_ -= kQ1;
      high_ -= kQ1;
    } else {
      break;
    }
    low_ = 2 * low_;
    high_ = 2 * high_ + 1;
  }
  ++symbols_;
  if (model.count.size() > 1) ++trace_.symbols;
}

void SegmentWriter::flush() {
  ++pending_;
  emit(low_ < kQ1 ? 0 : 1);
  if (symbols_ == 0) ++trace_.empty_segments;
  trace_.segment_end.push_back(out_.bit.size());
  trace_.zeros_at_end.push_back(zeros_);
}

void SegmentWriter::emit(int bit) {
  put(bit);
  for (; pending_ > 0; --pending_) put(1 - bit);
}

void SegmentWriter::put(int bit) {
  if (zeros_ == kZeros) {
    out_.bit.push_back(bad_stuffing_ ? 0 : 1);
    bad_stuffing_ = false;
    ++trace_.stuffed;
    zeros_ = 0;
  }
  out_.bit.push_back(std::uint8_t(bit));
  zeros_ = bit == 0 ? zeros_ + 1 : 0;
}

}  // namespace animeme::conformance
