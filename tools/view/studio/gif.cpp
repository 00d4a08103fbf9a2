#include "tools/view/studio/gif.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace animeme::studio {
namespace {

constexpr int kGifSide = 16383;
constexpr int kShortest = 2;     // hundredths: players stretch what is shorter
constexpr int kLongest = 65535;  // hundredths, of one picture
constexpr std::size_t kBins = 32 * 64 * 32;

/// Colours that are alike: 5 bits of red and blue, 6 of green.
struct ColourBin {
  std::uint32_t count = 0;
  std::array<std::uint32_t, 3> sum{};
};

std::size_t bin_of(const std::uint8_t* p) {
  return std::size_t(p[0] >> 3) << 11 | std::size_t(p[1] >> 2) << 5 | std::size_t(p[2] >> 3);
}

using Rgb = std::array<std::uint8_t, 3>;

/// Bins with their mean colours, and the palette of a picture by median cut: the box with the
/// largest spread of colours, weighed by its pixels, is cut at its median until there are enough.
class Palette {
 public:
  Palette() : bins_(kBins), index_(kBins, 0) {}

  void count(const std::uint8_t* pixel) {
    const std::size_t number = bin_of(pixel);
    ColourBin& bin = bins_[number];
    if (bin.count++ == 0) used_.push_back(std::uint16_t(number));
    for (std::size_t k = 0; k < 3; ++k) bin.sum[k] += pixel[k];
  }

  void make(std::size_t most) {
    std::vector<Box> boxes = {box_of(0, used_.size())};
    while (boxes.size() < most) {
      const auto widest = std::max_element(
          boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.cost < b.cost; });
      if (!(widest->cost > 0)) break;
      const Box cut = *widest;
      const std::size_t middle = split(cut);
      *widest = box_of(cut.first, middle);
      boxes.push_back(box_of(middle, cut.last));
    }
    for (const Box& box : boxes) {
      std::array<double, 3> sum{};
      double pixels = 0;
      for (std::size_t i = box.first; i < box.last; ++i) {
        const ColourBin& bin = bins_[used_[i]];
        for (std::size_t k = 0; k < 3; ++k) sum[k] += bin.sum[k];
        pixels += bin.count;
        index_[used_[i]] = std::uint8_t(colours_.size());
      }
      Rgb colour{};
      for (std::size_t k = 0; k < 3; ++k)
        colour[k] = std::uint8_t(std::lround(sum[k] / std::max(pixels, 1.0)));
      colours_.push_back(colour);
    }
  }

  const std::vector<Rgb>& colours() const { return colours_; }
  std::uint8_t index_of(const std::uint8_t* pixel) const { return index_[bin_of(pixel)]; }

 private:
  struct Box {
    std::size_t first, last;  // in used_
    std::size_t axis;         // along which it is widest
    double cost;              // 0: one colour
  };

  double mean(std::uint16_t bin, std::size_t axis) const {
    return double(bins_[bin].sum[axis]) / bins_[bin].count;
  }

  Box box_of(std::size_t first, std::size_t last) const {
    Box box{first, last, 0, 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double sum = 0, squares = 0, pixels = 0;
      for (std::size_t i = first; i < last; ++i) {
        const double value = mean(used_[i], axis), n = bins_[used_[i]].count;
        sum += n * value;
        squares += n * value * value;
        pixels += n;
      }
      const double cost = pixels > 0 ? squares - sum * sum / pixels : 0;
      if (cost > box.cost + 1e-6) {
        box.cost = cost;
        box.axis = axis;
      }
    }
    if (last - first < 2) box.cost = 0;
    return box;
  }

  // Sorted along its axis; both sides have bins.
  std::size_t split(const Box& box) {
    const auto begin = used_.begin() + std::ptrdiff_t(box.first);
    const auto end = used_.begin() + std::ptrdiff_t(box.last);
    std::sort(begin, end, [&](std::uint16_t a, std::uint16_t b) {
      const double x = mean(a, box.axis), y = mean(b, box.axis);
      return x != y ? x < y : a < b;
    });
    std::uint64_t pixels = 0, half = 0;
    for (auto i = begin; i != end; ++i) pixels += bins_[*i].count;
    std::size_t at = box.first;
    while (at + 1 < box.last && 2 * half < pixels) half += bins_[used_[at++]].count;
    return std::clamp(at, box.first + 1, box.last - 1);
  }

  std::vector<ColourBin> bins_;
  std::vector<std::uint8_t> index_;
  std::vector<std::uint16_t> used_;
  std::vector<Rgb> colours_;
};

/// Codes of growing length, in blocks of up to 255 bytes.
class CodeBytes {
 public:
  explicit CodeBytes(std::vector<std::uint8_t>& file) : file_(file) {}

  void put(std::uint32_t code, int bits) {
    pending_ |= code << count_;
    count_ += bits;
    while (count_ >= 8) {
      add(std::uint8_t(pending_ & 255));
      pending_ >>= 8;
      count_ -= 8;
    }
  }
  void end() {
    if (count_ > 0) add(std::uint8_t(pending_ & 255));
    flush();
    file_.push_back(0);
  }

 private:
  void add(std::uint8_t byte) {
    block_.push_back(byte);
    if (block_.size() == 255) flush();
  }
  void flush() {
    if (block_.empty()) return;
    file_.push_back(std::uint8_t(block_.size()));
    file_.insert(file_.end(), block_.begin(), block_.end());
    block_.clear();
  }

  std::vector<std::uint8_t>& file_;
  std::vector<std::uint8_t> block_;
  std::uint32_t pending_ = 0;
  int count_ = 0;
};

// LZW: a string of indices that is known, and the index that follows it, are a new string.
void write_indices(const std::vector<std::uint8_t>& indices, int index_bits,
                   std::vector<std::uint8_t>& file) {
  constexpr std::uint32_t kMostCodes = 4096;
  constexpr std::size_t kSlots = 1 << 14;
  const std::uint32_t clear = 1U << index_bits;
  file.push_back(std::uint8_t(index_bits));
  CodeBytes out(file);
  std::vector<std::uint32_t> keys(kSlots), codes(kSlots);  // by string and index
  std::uint32_t next = clear + 2;
  int bits = index_bits + 1;
  const auto restart = [&] {
    std::fill(keys.begin(), keys.end(), ~0U);
    next = clear + 2;
    bits = index_bits + 1;
  };
  restart();
  out.put(clear, bits);
  std::uint32_t string = indices.front();
  for (std::size_t i = 1; i < indices.size(); ++i) {
    const std::uint32_t key = string << 8 | indices[i];
    std::size_t slot = (key * 2654435761U) >> 18;
    while (keys[slot] != ~0U && keys[slot] != key) slot = (slot + 1) % kSlots;
    if (keys[slot] == key) {
      string = codes[slot];
      continue;
    }
    out.put(string, bits);
    string = indices[i];
    if (next == kMostCodes) {
      out.put(clear, bits);
      restart();
      continue;
    }
    keys[slot] = key;
    codes[slot] = next;
    // A code that needs one bit more can be the next one written.
    if (next == 1U << bits) ++bits;
    ++next;
  }
  out.put(string, bits);
  if (next == 1U << bits && bits < 12) ++bits;
  out.put(clear + 1, bits);
  out.end();
}

void put16(std::vector<std::uint8_t>& file, int value) {
  file.push_back(std::uint8_t(value & 255));
  file.push_back(std::uint8_t(value >> 8));
}

}  // namespace

Gif::Gif(int width, int height, int quality)
    : width_(width),
      height_(height),
      colours_(std::clamp(quality * 255 / 80, 32, 255)),
      tolerance_(std::clamp((110 - quality) / 5, 2, 16)) {}

void Gif::begin_file() {
  constexpr std::string_view kLoop = "NETSCAPE2.0";
  for (const char c : std::string_view("GIF89a")) file_.push_back(std::uint8_t(c));
  put16(file_, width_);
  put16(file_, height_);
  file_.insert(file_.end(), {0x70, 0, 0, 0x21, 0xFF, std::uint8_t(kLoop.size())});
  for (const char c : kLoop) file_.push_back(std::uint8_t(c));
  file_.insert(file_.end(), {3, 1, 0, 0, 0});
}

Result<void> Gif::push(std::span<const std::uint8_t> rgba, int milliseconds) {
  const auto fits = [](int side) { return side >= 1 && side <= kGifSide; };
  if (!fits(width_) || !fits(height_) ||
      rgba.size() != std::size_t(width_) * std::size_t(height_) * 4) {
    return make_error(Code::invalid_argument, "the picture has another size than the animation");
  }
  const int time = (milliseconds + 5) / 10;
  if (!pending_.empty() && time - pending_time_ >= kShortest) {
    write_pending(time);
    pending_time_ = time;
  } else if (pending_.empty()) {
    pending_time_ = time;
  }
  pending_.assign(rgba.begin(), rgba.end());
  return {};
}

void Gif::write_pending(int until) {
  const bool first = file_.empty();
  if (first) begin_file();
  const std::size_t pixels = std::size_t(width_) * std::size_t(height_);
  if (first) shown_.resize(pixels * 3);
  int left = width_, right = -1, top = height_, bottom = -1;
  std::vector<bool> changed(pixels);
  Palette palette;
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* from = &pending_[4 * i];
    const std::uint8_t* now = &shown_[3 * i];
    const int off = std::max(
        {std::abs(from[0] - now[0]), std::abs(from[1] - now[1]), std::abs(from[2] - now[2])});
    if (!first && off <= tolerance_) continue;
    changed[i] = true;
    palette.count(from);
    const int x = int(i % std::size_t(width_)), y = int(i / std::size_t(width_));
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  const int delay = std::min(until - pending_time_, kLongest);
  if (right < left) {  // the picture before lasts longer
    delay_ = std::min(delay_ + delay, kLongest);
    file_[delay_at_] = std::uint8_t(delay_ & 255);
    file_[delay_at_ + 1] = std::uint8_t(delay_ >> 8);
    return;
  }
  palette.make(std::size_t(colours_));
  const std::vector<Rgb>& colours = palette.colours();
  const std::size_t transparent = colours.size();
  int index_bits = 2;
  while ((std::size_t(1) << index_bits) < colours.size() + 1) ++index_bits;

  // Pictures stay; one index leaves what is there.
  file_.insert(file_.end(), {0x21, 0xF9, 4, 0x05});
  delay_at_ = file_.size();
  delay_ = delay;
  put16(file_, delay);
  file_.insert(file_.end(), {std::uint8_t(transparent), 0, 0x2C});
  put16(file_, left);
  put16(file_, top);
  put16(file_, right - left + 1);
  put16(file_, bottom - top + 1);
  file_.push_back(std::uint8_t(0x80 | (index_bits - 1)));
  for (std::size_t i = 0; i < std::size_t(1) << index_bits; ++i) {
    const Rgb colour = i < colours.size() ? colours[i] : Rgb{};
    file_.insert(file_.end(), colour.begin(), colour.end());
  }
  std::vector<std::uint8_t> indices;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(width_) + std::size_t(x);
      if (!changed[i]) {
        indices.push_back(std::uint8_t(transparent));
        continue;
      }
      indices.push_back(palette.index_of(&pending_[4 * i]));
      std::copy(colours[indices.back()].begin(), colours[indices.back()].end(), &shown_[3 * i]);
    }
  }
  write_indices(indices, index_bits, file_);
}

Result<std::vector<std::uint8_t>> Gif::finish(int milliseconds) {
  if (pending_.empty()) return make_error(Code::invalid_argument, "there is no picture");
  write_pending(std::max((milliseconds + 5) / 10, pending_time_ + kShortest));
  file_.push_back(0x3B);
  return std::move(file_);
}

}  // namespace animeme::studio
