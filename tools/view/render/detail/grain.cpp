#include "tools/view/render/detail/grain.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace animeme::render::detail {
namespace {

// Lengths in the block: a texel is 14 units, a cell with one grain of skin 64.
constexpr int kUnits = 14, kCell = 64, kCells = kGrainSize * kUnits / kCell;
static_assert(kCells * kCell == kGrainSize * kUnits);
constexpr int kLong = 6;  // a line of lips is so many times longer than wide
// Quarters of an octave from which on a grain has two pixels and changes them by less than a step.
constexpr int kCoarsest = 5;
constexpr float kMiddle = 64 * kGrainSize;  // added to places, which are not negative then

std::uint32_t scrambled(std::uint32_t h) {
  h = (h ^ (h >> 15)) * 2246822519u;
  h = (h ^ (h >> 13)) * 3266489917u;
  return h ^ (h >> 16);
}

// Middles of the grains of cells, from the corner of their cell; grains of lips go through the
// block from below and from behind.
struct Middles {
  explicit Middles(bool lines) : deep(lines ? kCells * kCell : kCell) {
    for (std::uint32_t cell = 0; cell < kCells * kCells * kCells; ++cell) {
      const std::uint32_t h = scrambled(2 * (lines ? cell % kCells : cell) + (lines ? 2 : 1));
      const auto size = std::uint32_t(deep);
      places[cell] = {int(h % kCell), int((h >> 8) % size), int((h >> 20) % size)};
    }
  }
  int deep;
  std::array<std::array<int, 3>, kCells * kCells * kCells> places;
};

// Height of the skin at a texel: the difference of the distances to the two nearest grains is 0 in
// the furrow between them.
double height_at(int tx, int ty, int tz, bool lines, const Middles& middles) {
  const auto unit = [](int texel) { return texel * kUnits + kUnits / 2; };
  const auto wrapped = [](int i) { return i < 0 ? i + kCells : i < kCells ? i : i - kCells; };
  const int x = unit(tx), y = unit(ty), z = unit(tz), deep = middles.deep;
  const int stretch = lines ? kLong * kLong : 1;
  int first = 1 << 30, second = 1 << 30;
  for (int c = z / deep - 1; c <= z / deep + 1; ++c) {
    for (int b = y / deep - 1; b <= y / deep + 1; ++b) {
      const int row = (wrapped(c) * kCells + wrapped(b)) * kCells;
      for (int a = x / kCell - 1; a <= x / kCell + 1; ++a) {
        const auto& [mx, my, mz] = middles.places[std::size_t(row + wrapped(a))];
        const int dx = a * kCell + mx - x, dy = b * deep + my - y, dz = c * deep + mz - z;
        const int square = stretch * dx * dx + dy * dy + dz * dz;
        second = std::min(second, std::max(first, square));
        first = std::min(first, square);
      }
    }
  }
  const double apart = (std::sqrt(double(second)) - std::sqrt(double(first))) / (lines ? kLong : 1);
  return std::min(apart / 36, 1.0);
}

// Half as many texels a side, each the mean of eight.
std::vector<std::int8_t> halved(const std::vector<std::int8_t>& fine, int size) {
  std::vector<std::int8_t> coarse;
  for (int texel = 0; texel < size * size * size / 8; ++texel) {
    const int half = size / 2;
    const int x = 2 * (texel % half), y = 2 * (texel / half % half), z = 2 * (texel / half / half);
    for (int channel = 0; channel < 2; ++channel) {
      int sum = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const int at = ((z + corner / 4) * size + y + corner / 2 % 2) * size + x + corner % 2;
        sum += fine[std::size_t(2 * at + channel)];
      }
      coarse.push_back(std::int8_t(sum / 8));
    }
  }
  return coarse;
}

}  // namespace

std::vector<std::uint8_t> grain_block() {
  std::vector<std::uint8_t> block(2 * kGrainSize * kGrainSize * kGrainSize);
  std::vector<double> heights(block.size() / 2);
  for (int channel = 0; channel < 2; ++channel) {
    const auto texel = [](int x, int y, int z) {
      const auto wrapped = [](int i) { return i & (kGrainSize - 1); };
      return std::size_t((wrapped(z) * kGrainSize + wrapped(y)) * kGrainSize + wrapped(x));
    };
    const auto each = [](const auto& visit) {
      for (int i = 0; i < kGrainSize * kGrainSize * kGrainSize; ++i)
        visit(i % kGrainSize, i / kGrainSize % kGrainSize, i / kGrainSize / kGrainSize);
    };
    const Middles middles(channel == 1);
    each([&](int x, int y, int z) {
      heights[texel(x, y, z)] = height_at(x, y, z, channel == 1, middles);
    });
    each([&](int x, int y, int z) {
      // What falls towards the light is bright; furrows are dark.
      const double here = heights[texel(x, y, z)];
      const double slope = here - heights[texel(x + 1, y + 1 - channel, z + 1 - channel)];
      const double light = 0.9 * slope + 0.7 * (here - 0.45);
      block[2 * texel(x, y, z) + std::size_t(channel)] =
          std::uint8_t(std::clamp(std::floor(128.5 + 127 * light), 1.0, 255.0));
    });
  }
  return block;
}

void GrainTable::set(float texel) {
  const int level = std::min(int(std::lround(-4 * std::log2(std::max(texel, 1e-3f)))), kCoarsest);
  if (level == level_) return;
  level_ = level;
  values_.clear();
  smooth_ = level < -1;
  if (level >= kCoarsest) return;
  static const std::vector<std::uint8_t> kBlock = grain_block();
  for (const std::uint8_t byte : kBlock) values_.push_back(std::int8_t(int(byte) - 128));
  int size = kGrainSize;
  const int octaves = std::max(level, 0) / 4, quarters = std::max(level, 0) % 4;
  for (int i = 0; i < octaves; ++i, size /= 2) values_ = halved(values_, size);
  mask_ = Int4{} + (size - 1);
  shift_ = std::countr_zero(unsigned(size));
  scale_ = 1 / (kGrainTexel * float(1 << octaves));
  if (quarters == 0) return;
  const std::vector<std::int8_t> coarse = halved(values_, size);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const int at = int(i / 2), half = size / 2;
    const int x = at % size / 2, y = at / size % size / 2, z = at / size / size / 2;
    const int mean = coarse[2 * std::size_t((z * half + y) * half + x) + i % 2];
    values_[i] = std::int8_t((values_[i] * (4 - quarters) + mean * quarters) / 4);
  }
}

float GrainTable::between(const Float4& p, bool lines) const {
  const Float4 q = p - 0.5f;
  const Int4 low = __builtin_convertvector(q, Int4);
  const Float4 share = q - __builtin_convertvector(low, Float4);
  const Int4 i = low & mask_, j = (low + 1) & mask_;
  // Along x in each of four rows, two in each of two sheets.
  const Float4 left{value(i[0], i[1], i[2], lines), value(i[0], j[1], i[2], lines),
                    value(i[0], i[1], j[2], lines), value(i[0], j[1], j[2], lines)};
  const Float4 right{value(j[0], i[1], i[2], lines), value(j[0], j[1], i[2], lines),
                     value(j[0], i[1], j[2], lines), value(j[0], j[1], j[2], lines)};
  const Float4 rows = left + (right - left) * share[0];
  const float near = rows[0] + (rows[1] - rows[0]) * share[1];
  const float far = rows[2] + (rows[3] - rows[2]) * share[1];
  return near + (far - near) * share[2];
}

head::Vec3 GrainTable::place(const head::Vec3& p) const {
  const float x = 0.8365f * p.x + 0.5480f * p.z, z = 0.8365f * p.z - 0.5480f * p.x;
  return head::Vec3{x, 0.9713f * p.y - 0.2377f * z, 0.2377f * p.y + 0.9713f * z} * scale_ +
         head::Vec3{kMiddle, kMiddle, kMiddle};
}

}  // namespace animeme::render::detail
