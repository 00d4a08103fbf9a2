#include "fap/head/detail/diffuse.h"

namespace animeme::head::detail {
namespace {

constexpr int kRounds = 40;

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

  void apply(const Weights& in, Weights& out) const {
    std::size_t edge = 0;
    for (std::uint32_t v = 0; v < sum_.size(); ++v) {
      const std::span<float> row = out.row(v);
      const std::span<const float> own = in.row(v);
      for (std::size_t c = 0; c < row.size(); ++c) row[c] = sum_[v] * own[c];
      for (const std::uint32_t n : neighbours_.of(v)) {
        const std::span<const float> other = in.row(n);
        const float share = share_[edge++];
        for (std::size_t c = 0; c < row.size(); ++c) row[c] -= share * other[c];
      }
    }
  }

 private:
  const Neighbours& neighbours_;
  std::vector<float> share_, sum_;
};

// Product of each column of a with that of b.
std::vector<double> products(const Weights& a, const Weights& b) {
  std::vector<double> sums(a.controls(), 0);
  for (std::size_t v = 0; v < a.vertices(); ++v) {
    const auto x = a.row(v);
    const auto y = b.row(v);
    for (std::size_t c = 0; c < sums.size(); ++c) sums[c] += double(x[c]) * double(y[c]);
  }
  return sums;
}

// to = keep * to + add * from, column by column.
void combine(std::span<const float> keep, Weights& to, std::span<const float> add,
             const Weights& from) {
  for (std::size_t v = 0; v < to.vertices(); ++v) {
    const std::span<float> row = to.row(v);
    const std::span<const float> other = from.row(v);
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = keep[c] * row[c] + add[c] * other[c];
  }
}

}  // namespace

void diffuse(std::span<const Vec3> positions, const Neighbours& neighbours,
             std::span<const float> radii, Weights& table) {
  const Flow flow(positions, neighbours, radii);
  const std::vector<float> ones(table.controls(), 1);
  std::vector<float> step(table.controls());
  Weights image(table.vertices(), table.controls());
  Weights rest = table;
  flow.apply(table, image);
  combine(ones, rest, std::vector<float>(table.controls(), -1), image);
  Weights direction = rest;
  std::vector<double> size = products(rest, rest);
  for (int round = 0; round < kRounds; ++round) {
    flow.apply(direction, image);
    const std::vector<double> along = products(direction, image);
    for (std::size_t c = 0; c < step.size(); ++c) {
      step[c] = along[c] > 0 ? float(size[c] / along[c]) : 0;
    }
    combine(ones, table, step, direction);
    for (float& s : step) s = -s;
    combine(ones, rest, step, image);
    const std::vector<double> next = products(rest, rest);
    for (std::size_t c = 0; c < step.size(); ++c) {
      step[c] = size[c] > 0 ? float(next[c] / size[c]) : 0;
    }
    combine(step, direction, ones, rest);
    size = next;
  }
}

}  // namespace animeme::head::detail
