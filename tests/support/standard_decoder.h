// A second decoder of the FBA bitstream, small, slow and plain: codec/bitstream.md read to the
// letter, above all its rule of stuffing in front of start codes. It takes only the tables of
// numbers from the library; what it gives is compared with what the library's decoder gives.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "codec/syntax/body_tables.h"
#include "fap/tables.h"

namespace animeme::test {

class StandardDecoder {
 public:
  /// Values by number; those of FAP 1 and 2 by 100 * FAP + their place, flags included.
  using Values = std::map<int, std::int64_t>;

  struct Plane {
    bool intra = false;
    int object_mask = 0;
    long skip = 0;
    Values face, body;
    std::size_t bit = 0;  // of its header
  };

  /// All planes of a stream. Throws std::runtime_error if it is not legal.
  static std::vector<Plane> decode(const std::vector<std::uint8_t>& bytes) {
    return StandardDecoder(bytes).run();
  }

 private:
  explicit StandardDecoder(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {
    face_.defaults = [](int number) {
      const fap::FapInfo& info = fap::info(number);
      return std::array{info.default_i_range, info.default_p_range};
    };
    int number = fap::kFirstLowLevel;
    for (const int size : {16, 12, 8, 4, 5, 3, 10, 4, 4}) {
      for (int i = 0; i < size; ++i, ++number) {
        face_.members.push_back({number, fap::info(number).quant_step, i % 4 == 0});
      }
    }
    body_.defaults = [](int) { return std::array{1860, 1860}; };
    std::size_t slot = 0;
    for (const int size : fba::kBodyGroupSizes) {
      for (int i = 0; i < size; ++i, ++slot) {
        body_.members.push_back({fba::kBapOrder[slot], fba::kBapSteps[slot], i % 4 == 0});
      }
    }
  }

  // --- bits

  [[noreturn]] static void fail(const std::string& what) { throw std::runtime_error(what); }

  unsigned bit_at(std::size_t bit) const {
    if (bit / 8 >= bytes_.size()) return 0;
    return (bytes_[bit / 8] >> (7 - bit % 8)) & 1U;
  }
  unsigned bits(int count) {
    unsigned value = 0;
    for (int i = 0; i < count; ++i) value = value * 2 + bit_at(at_++);
    if (at_ > bytes_.size() * 8) fail("the stream ends within a plane");
    return value;
  }
  unsigned code_at(std::size_t bit) const {
    unsigned value = 0;
    for (std::size_t i = 0; i < 32; ++i) value = value * 2 + bit_at(bit + i);
    return value;
  }
  void marker() {
    if (bits(1) != 1) fail("a marker bit is 0 at bit " + std::to_string(at_ - 1));
  }

  // The place behind the 1 to 8 bits up to the byte border.
  std::size_t border() const { return (at_ / 8 + 1) * 8; }

  // --- the stream

  std::vector<Plane> run() {
    headers();
    std::vector<Plane> planes;
    for (;;) {
      // What the bits up to the border say is not looked at.
      const unsigned code = code_at(border());
      if (code == 0x1BB || code == 0x103) {
        at_ = border() + 32;
      } else if (!planes.empty() && (code == 0x1B0 || code == 0x1BA || code == 0x101)) {
        at_ = border();
        headers();  // of another object
      } else if (!planes.empty() && (code >> 8 == 1 || border() >= bytes_.size() * 8)) {
        return planes;
      }
      planes.push_back(plane());
    }
  }

  // Whatever stands in front of the object is passed over.
  void headers() {
    for (; at_ < bytes_.size() * 8; at_ += 8) {
      const unsigned code = code_at(at_);
      if (code != 0x1BA && code != 0x101) continue;
      at_ += 32;
      return;
    }
    fail("no object");
  }

  Plane plane() {
    Plane plane;
    plane.bit = at_;
    plane.intra = bits(1) != 0;
    plane.object_mask = int(bits(2));
    if (plane.object_mask == 0) return plane;
    if (plane.intra && bits(1) != 0) bits(13);
    if (plane.intra && bits(1) != 0) {
      bits(11);
      marker();
      bits(6);
    }
    if (bits(1) != 0) {
      unsigned part = 0;
      do {
        part = bits(4);
        plane.skip += part;
      } while (part == 15);
    }
    if ((plane.object_mask & 1) != 0) face(plane);
    if ((plane.object_mask & 2) != 0) body(plane);
    return plane;
  }

  // --- the arithmetic coder

  struct Model {
    std::vector<int> frequency;
    Model() = default;
    explicit Model(int symbols) : frequency(std::size_t(symbols), 1) {}
    void update(int symbol) {
      int total = 0;
      for (const int f : frequency) total += f;
      if (total == 16383) {
        for (int& f : frequency) f = (f + 1) / 2;
      }
      ++frequency[std::size_t(symbol)];
    }
  };

  // One run of the coder. The place of each bit of the window is kept, since the last 14 belong to
  // what follows.
  struct Segment {
    StandardDecoder& in;
    std::size_t next = 0;
    int zeros = 0;
    int low = 0, high = 65535, value = 0;
    std::vector<std::size_t> place;

    explicit Segment(StandardDecoder& decoder) : in(decoder), next(decoder.at_) {
      for (int i = 0; i < 16; ++i) value = value * 2 + take();
    }
    int take() {
      if (zeros == 22) {
        ++next;
        zeros = 0;
      }
      const int bit = int(in.bit_at(next));
      zeros = bit == 1 ? 0 : zeros + 1;
      place.push_back(next++);
      return bit;
    }
    int decode(const Model& model) {
      const int n = int(model.frequency.size());
      std::vector<int> c(std::size_t(n) + 1, 0);
      for (int k = n - 1; k >= 0; --k) {
        c[std::size_t(k)] = c[std::size_t(k) + 1] + model.frequency[std::size_t(k)];
      }
      const int length = high - low + 1;
      const int t = ((value - low + 1) * c[0] - 1) / length;
      int k = 0;
      while (k + 1 < n && c[std::size_t(k) + 1] > t) ++k;
      high = low - 1 + length * c[std::size_t(k)] / c[0];
      low = low + length * c[std::size_t(k) + 1] / c[0];
      for (;;) {
        int offset = 0;
        if (high < 32768) {
        } else if (low >= 32768) {
          offset = 32768;
        } else if (low >= 16384 && high < 49152) {
          offset = 16384;
        } else {
          return k;
        }
        low = 2 * (low - offset);
        high = 2 * (high - offset) + 1;
        value = 2 * (value - offset) + take();
      }
    }
    void end() { in.at_ = place[place.size() - 15] + 1; }
  };

  // --- FAP 1 and 2

  struct High {
    bool select = false;
    std::int64_t value = 0;
    Model predictive;
    int max = 0;
  };

  int high_step() const { return quant_ == 0 ? 1 : quant_; }

  void high_segment(int fap, bool intra, Plane& plane) {
    auto& group = high_[std::size_t(fap - 1)];
    Segment segment(*this);
    for (std::size_t i = 0; i < group.size(); ++i) {
      High& high = group[i];
      if (intra) {
        high.max = high.select   ? (fap == 1 ? 14 : 6)
                   : quant_ == 0 ? 63
                                 : (63 + quant_ / 2) / quant_;
        high.predictive = Model(2 * high.max + 1);
      }
      const int step = high.select ? 1 : high_step();
      if (intra) {
        high.value = std::int64_t(segment.decode(Model(high.max + 1))) * step;
      } else {
        const int symbol = segment.decode(high.predictive);
        high.predictive.update(symbol);
        high.value += std::int64_t(symbol - high.max) * step;
      }
      plane.face[100 * fap + int(i)] = high.value;
    }
    segment.end();
  }

  // --- low-level FAPs and BAPs

  struct Member {
    int number = 0;
    int step = 1;
    bool marked = false;  // a marker bit stands in front of its range
  };
  struct Family {
    std::vector<Member> members;
    std::array<int, 2> (*defaults)(int number) = nullptr;
    std::map<int, bool> coded;
    std::map<int, std::array<int, 4>> range;  // levels: intra max, min, predictive max, min
    std::map<int, Model> model;
    std::map<int, std::int64_t> value;
    int scale = 1;               // divisor of ranges, factor of steps
    bool scale_is_none = false;  // quantiser 0: steps of 1
  };

  void ranges(Family& family) {
    std::array<bool, 4> sent{};
    for (bool& flag : sent) flag = bits(1) != 0;
    if (family.range.empty()) {
      for (const Member& member : family.members) {
        const auto [intra, predictive] = family.defaults(member.number);
        const int i = (intra + 59) / 60 * 60 / family.scale;
        const int p = (predictive + 59) / 60 * 60 / family.scale;
        family.range[member.number] = {i, -i, p, -p};
      }
    }
    for (std::size_t kind = 0; kind < 4; ++kind) {
      if (!sent[kind]) continue;
      for (const Member& member : family.members) {
        if (member.marked) marker();
        if (!family.coded[member.number]) continue;
        const int level = int(bits(5)) * 60 / family.scale;
        family.range[member.number][kind] = kind % 2 == 0 ? level : -level;
      }
    }
    for (const Member& member : family.members) {
      const auto& range = family.range[member.number];
      if (family.coded[member.number]) family.model[member.number] = Model(range[2] - range[3] + 1);
    }
  }

  void segment(Family& family, bool intra, Values& values) {
    Segment segment(*this);
    for (const Member& member : family.members) {
      if (!family.coded[member.number]) continue;
      const auto& range = family.range[member.number];
      std::int64_t& value = family.value[member.number];
      const std::int64_t step = std::int64_t(member.step) * family.scale;
      if (intra) {
        const int symbol = segment.decode(Model(range[0] - range[1] + 1));
        value = (symbol + range[1]) * (family.scale_is_none ? 1 : step);
      } else {
        Model& model = family.model[member.number];
        const int symbol = segment.decode(model);
        model.update(symbol);
        value += (symbol + range[3]) * (family.scale_is_none ? 1 : step);
      }
      values[member.number] = value;
    }
    segment.end();
  }

  void face(Plane& plane) {
    if (plane.intra) {
      quant_ = int(bits(5));
      face_.scale = high_step();
      face_.scale_is_none = quant_ == 0;
      int number = 1;
      for (const int size : {2, 16, 12, 8, 4, 5, 3, 10, 4, 4}) {
        marker();
        const unsigned type = bits(2);
        for (int i = 0; i < size; ++i, ++number) {
          face_.coded[number] = type == 3 || ((type == 1 || type == 2) && bits(1) != 0);
        }
      }
      bits(1);
      if (bits(1) != 0) fail("DCT mode");
      ranges(face_);
    }
    if (face_.coded.empty()) fail("no intra plane");
    if (face_.coded[1]) {
      high_segment(1, plane.intra, plane);
      plane.face[103] = bits(1);
    }
    if (face_.coded[2]) {
      high_segment(2, plane.intra, plane);
      plane.face[204] = bits(1);
      plane.face[205] = bits(1);
    }
    segment(face_, plane.intra, plane.face);
  }

  void body(Plane& plane) {
    if (plane.intra) {
      const unsigned index = bits(5);
      body_.scale = index == 0 ? 1 : fba::kBapScale[index];
      body_.scale_is_none = index == 0;
      std::size_t slot = 0;
      for (const int size : fba::kBodyGroupSizes) {
        marker();
        const unsigned type = bits(2);
        for (int i = 0; i < size; ++i, ++slot) {
          body_.coded[body_.members[slot].number] = type == 3 || (type == 1 && bits(1) != 0);
        }
      }
      bits(1);
      if (bits(1) != 0) fail("DCT mode");
      ranges(body_);
    }
    if (body_.coded.empty()) fail("no intra plane");
    segment(body_, plane.intra, plane.body);
  }

  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
  int quant_ = 1;
  Family face_, body_;
  std::array<std::vector<High>, 2> high_{
      std::vector<High>{{.select = true}, {.select = true}, {}},
      std::vector<High>{{.select = true}, {}, {.select = true}, {}}};
};

}  // namespace animeme::test
