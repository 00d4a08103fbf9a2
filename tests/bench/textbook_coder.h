// The FBA coder as the description writes it (codec/bitstream.md, sections 4 to 7): one bit at a
// time, linear tables of cumulative frequencies, no thought for speed. The yardstick of
// bench_codec, and what tests/codec/arith_test.cpp compares the fast coder with. It shares no code
// with the codec.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace animeme::textbook {

/// Bits, most significant first; the reader gives zeros past the end.
struct Bits {
  std::vector<std::uint8_t> bytes;
  std::size_t count = 0;

  void put(int bit) {
    if (count % 8 == 0) bytes.push_back(0);
    if (bit != 0) bytes[count / 8] |= std::uint8_t(0x80 >> (count % 8));
    ++count;
  }
  void put(std::uint32_t value, int size) {
    for (int i = size - 1; i >= 0; --i) put(int((value >> i) & 1));
  }
  int get(std::size_t position) const {
    if (position / 8 >= bytes.size()) return 0;
    return (bytes[position / 8] >> (7 - position % 8)) & 1;
  }
};

/// Frequencies f[k] and their sums from the high end, c[k] = f[k] + ... + f[n-1].
struct Model {
  std::vector<int> f;
  std::vector<int> c;

  explicit Model(int n) : f(std::size_t(n), 1), c(std::size_t(n) + 1) { sum_up(); }
  void sum_up() {
    c[f.size()] = 0;
    for (std::size_t k = f.size(); k > 0; --k) c[k - 1] = c[k] + f[k - 1];
  }
  void update(int symbol) {
    if (c[0] == 16383) {
      for (int& frequency : f) frequency = (frequency + 1) / 2;
      sum_up();
    }
    ++f[std::size_t(symbol)];
    for (int k = 0; k <= symbol; ++k) ++c[std::size_t(k)];
  }
};

constexpr std::int64_t kQ1 = 16384;
constexpr std::int64_t kQ2 = 32768;
constexpr std::int64_t kQ3 = 49152;

/// Writes a segment.
class SegmentWriter {
 public:
  explicit SegmentWriter(Bits& out) : out_(out) {}

  void encode(const Model& model, int symbol) {
    const std::int64_t length = high_ - low_ + 1;
    const std::int64_t total = model.c[0];
    high_ = low_ - 1 + length * model.c[std::size_t(symbol)] / total;
    low_ = low_ + length * model.c[std::size_t(symbol) + 1] / total;
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
  }
  void flush() {
    ++pending_;
    emit(low_ < kQ1 ? 0 : 1);
  }
  int stuffed() const { return stuffed_; }

 private:
  void emit(int bit) {
    code_bit(bit);
    for (; pending_ > 0; --pending_) code_bit(1 - bit);
  }
  void code_bit(int bit) {
    if (zeros_ == 22) {
      out_.put(1);
      zeros_ = 0;
      ++stuffed_;
    }
    out_.put(bit);
    zeros_ = bit == 1 ? 0 : zeros_ + 1;
  }

  Bits& out_;
  std::int64_t low_ = 0;
  std::int64_t high_ = 65535;
  int pending_ = 0;
  int zeros_ = 0;
  int stuffed_ = 0;
};

/// Reads a segment that begins at `position`.
class SegmentReader {
 public:
  SegmentReader(const Bits& in, std::size_t position) : in_(in), position_(position) {
    for (int i = 0; i < 16; ++i) shift_in();
  }

  int decode(const Model& model) {
    const std::int64_t length = high_ - low_ + 1;
    const std::int64_t total = model.c[0];
    const std::int64_t target = ((value_ - low_ + 1) * total - 1) / length;
    int symbol = 0;
    while (model.c[std::size_t(symbol) + 1] > target) ++symbol;
    high_ = low_ - 1 + length * model.c[std::size_t(symbol)] / total;
    low_ = low_ + length * model.c[std::size_t(symbol) + 1] / total;
    for (;;) {
      std::int64_t offset = 0;
      if (high_ < kQ2) {
        offset = 0;
      } else if (low_ >= kQ2) {
        offset = kQ2;
      } else if (low_ >= kQ1 && high_ < kQ3) {
        offset = kQ1;
      } else {
        break;
      }
      low_ = 2 * (low_ - offset);
      high_ = 2 * (high_ - offset) + 1;
      value_ -= offset;
      shift_in();
    }
    return symbol;
  }
  /// Behind the second bit of the window.
  std::size_t end() const { return window_[1]; }

 private:
  void shift_in() {
    if (zeros_ == 22) {
      ++position_;  // the stuffed 1
      zeros_ = 0;
    }
    const int bit = in_.get(position_++);
    zeros_ = bit == 1 ? 0 : zeros_ + 1;
    value_ = 2 * value_ + bit;
    for (int i = 0; i < 15; ++i) window_[i] = window_[i + 1];
    window_[15] = position_;
  }

  const Bits& in_;
  std::size_t position_;
  std::int64_t low_ = 0;
  std::int64_t high_ = 65535;
  std::int64_t value_ = 0;
  int zeros_ = 0;
  std::size_t window_[16] = {};  // position behind each bit of the window
};

/// One coded parameter: its quantiser step and its levels in I [0] and P planes [1].
struct Parameter {
  int step = 1;
  int low[2] = {0, 0};
  int high[2] = {0, 0};
};

/// A stream of one intra plane and predictive planes without skipped frames.
struct Layout {
  int object_mask = 1;
  Bits intra_header;                            ///< everything between object mask and payload
  std::vector<std::vector<Parameter>> segment;  ///< of every plane, in order
  std::vector<int> flags;  ///< bits behind each segment, all 0 in what is written
};

/// Values of the parameters, segment after segment, of each plane.
using Planes = std::vector<std::vector<int>>;

inline int quantise(int value, int step) {
  const int magnitude = value < 0 ? -value : value;
  if (magnitude <= step / 2) return 0;
  return (value < 0 ? -1 : 1) * ((magnitude + step / 2) / step);
}

inline std::vector<Model> predictive_models(const Layout& layout) {
  std::vector<Model> models;
  for (const auto& segment : layout.segment) {
    for (const Parameter& p : segment) models.emplace_back(p.high[1] - p.low[1] + 1);
  }
  return models;
}

inline std::vector<std::uint8_t> encode(const Layout& layout, const Planes& planes) {
  Bits out;
  out.put(0x000001BA, 32);
  std::vector<Model> models = predictive_models(layout);
  std::vector<int> rec(models.size(), 0);
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    const int predictive = plane == 0 ? 0 : 1;
    out.put(1 - predictive);
    out.put(std::uint32_t(layout.object_mask), 2);
    if (predictive == 0) {
      for (std::size_t i = 0; i < layout.intra_header.count; ++i)
        out.put(layout.intra_header.get(i));
    } else {
      out.put(0);  // no frames skipped
    }
    std::size_t i = 0;
    for (std::size_t s = 0; s < layout.segment.size(); ++s) {
      SegmentWriter segment(out);
      for (const Parameter& p : layout.segment[s]) {
        const int level = quantise(planes[plane][i] - rec[i], p.step);
        const int symbol = level - p.low[predictive];
        if (predictive == 0) {
          segment.encode(Model(p.high[0] - p.low[0] + 1), symbol);
        } else {
          segment.encode(models[i], symbol);
          models[i].update(symbol);
        }
        rec[i] += level * p.step;
        ++i;
      }
      segment.flush();
      out.put(0, layout.flags[s]);
    }
  }
  out.put(0);
  while (out.count % 8 != 0) out.put(1);
  out.put(0x000001B1, 32);
  return out.bytes;
}

inline Planes decode(const Layout& layout, const std::vector<std::uint8_t>& bytes,
                     std::size_t count) {
  Bits in;
  in.bytes = bytes;
  std::size_t position = 32;
  std::vector<Model> models = predictive_models(layout);
  std::vector<int> rec(models.size(), 0);
  Planes planes;
  for (std::size_t plane = 0; plane < count; ++plane) {
    const int predictive = plane == 0 ? 0 : 1;
    position += 3 + (predictive == 0 ? layout.intra_header.count : 1);
    std::size_t i = 0;
    for (std::size_t s = 0; s < layout.segment.size(); ++s) {
      SegmentReader segment(in, position);
      for (const Parameter& p : layout.segment[s]) {
        int symbol = 0;
        if (predictive == 0) {
          symbol = segment.decode(Model(p.high[0] - p.low[0] + 1));
        } else {
          symbol = segment.decode(models[i]);
          models[i].update(symbol);
        }
        rec[i] += (symbol + p.low[predictive]) * p.step;
        ++i;
      }
      position = segment.end() + std::size_t(layout.flags[s]);
    }
    planes.push_back(rec);
  }
  return planes;
}

}  // namespace animeme::textbook
