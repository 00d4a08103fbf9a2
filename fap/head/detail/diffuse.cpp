#include "fap/head/detail/diffuse.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace animeme::head::detail {
namespace {

constexpr int kMostRounds = 40;
// What is left of the error, squared, when all columns of a block have arrived: a ten-thousandth,
// which is less than a thousandth of a millimetre in any pose.
constexpr double kArrived = 1e-8;

// Far from where values are, rounds leave ever smaller traces, and numbers that are nearly too
// small for a float take a processor a hundred times as long.
constexpr float kNothing = 1e-20f;

// Columns know nothing of each other: so many at a time stay in registers and in the cache.
constexpr std::size_t kWidth = 8;
using Row = std::array<float, kWidth>;
using Block = std::vector<Row>;

// The matrix of the step: unit and the flow between neighbours; symmetric.
class Flow {
 public:
  Flow(std::span<const Vec3> positions, const Neighbours& neighbours, std::span<const float> radii)
      : neighbours_(neighbours) {
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
      float sum = 1;
      for (const std::uint32_t n : neighbours.of(v)) {
        const Vec3 d = positions[n] - positions[v];
        const float reach = radii[v] * radii[v] + radii[n] * radii[n];
        share_.push_back(0.25f * reach / std::max(dot(d, d), 1e-4f));
        sum += share_.back();
      }
      sum_.push_back(sum);
    }
  }

  void apply(const Block& in, Block& out) const {
    std::size_t edge = 0;
    for (std::uint32_t v = 0; v < sum_.size(); ++v) {
      Row row;
      for (std::size_t c = 0; c < kWidth; ++c) row[c] = sum_[v] * in[v][c];
      for (const std::uint32_t n : neighbours_.of(v)) {
        const Row& other = in[n];
        const float share = share_[edge++];
        for (std::size_t c = 0; c < kWidth; ++c) row[c] -= share * other[c];
      }
      out[v] = row;
    }
  }

 private:
  const Neighbours& neighbours_;
  std::vector<float> share_, sum_;
};

using Sums = std::array<double, kWidth>;

// sums += the product of each column of two rows.
void add_products(const Row& a, const Row& b, Sums& sums) {
  for (std::size_t c = 0; c < kWidth; ++c) sums[c] += double(a[c]) * double(b[c]);
}

void diffuse(const Flow& flow, Block& table) {
  Block image(table.size()), rest(table.size());
  flow.apply(table, image);
  Sums size{};
  for (std::size_t v = 0; v < table.size(); ++v) {
    for (std::size_t c = 0; c < kWidth; ++c) rest[v][c] = table[v][c] - image[v][c];
    add_products(rest[v], rest[v], size);
  }
  Block direction = rest;
  const Sums first = size;
  const auto arrived = [&] {
    for (std::size_t c = 0; c < kWidth; ++c) {
      if (size[c] > kArrived * first[c]) return false;
    }
    return true;
  };
  for (int round = 0; round < kMostRounds && !arrived(); ++round) {
    flow.apply(direction, image);
    Sums along{}, next{};
    for (std::size_t v = 0; v < table.size(); ++v) add_products(direction[v], image[v], along);
    Row step;
    for (std::size_t c = 0; c < kWidth; ++c) {
      step[c] = along[c] > 0 ? float(size[c] / along[c]) : 0;
    }
    for (std::size_t v = 0; v < table.size(); ++v) {
      for (std::size_t c = 0; c < kWidth; ++c) {
        table[v][c] += step[c] * direction[v][c];
        rest[v][c] -= step[c] * image[v][c];
      }
      add_products(rest[v], rest[v], next);
    }
    for (std::size_t c = 0; c < kWidth; ++c) {
      step[c] = size[c] > 0 ? float(next[c] / size[c]) : 0;
    }
    for (std::size_t v = 0; v < table.size(); ++v) {
      for (std::size_t c = 0; c < kWidth; ++c) {
        const float value = step[c] * direction[v][c] + rest[v][c];
        direction[v][c] = std::abs(value) < kNothing ? 0 : value;
      }
    }
    size = next;
  }
}

}  // namespace

void diffuse(std::span<const Vec3> positions, const Neighbours& neighbours,
             std::span<const float> radii, Weights& table) {
  const Flow flow(positions, neighbours, radii);
  Block block(table.vertices());
  for (std::size_t first = 0; first < table.controls(); first += kWidth) {
    const std::size_t count = std::min(kWidth, table.controls() - first);
    for (std::size_t v = 0; v < block.size(); ++v) {
      block[v] = {};
      const auto row = table.row(v).subspan(first, count);
      std::copy(row.begin(), row.end(), block[v].begin());
    }
    diffuse(flow, block);
    for (std::size_t v = 0; v < block.size(); ++v) {
      std::copy_n(block[v].begin(), count, table.row(v).begin() + std::ptrdiff_t(first));
    }
  }
}

}  // namespace animeme::head::detail
