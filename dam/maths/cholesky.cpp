#include "dam/maths/cholesky.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Eigen::Index kTile = 192;
constexpr Eigen::Index kColumns = 16;  // right sides solved by one task

}  // namespace

bool cholesky_in_place(std::span<double> matrix, std::size_t n, int threads) {
  const auto size = Eigen::Index(n);
  Eigen::Map<Eigen::MatrixXd> a(matrix.data(), size, size);
  for (Eigen::Index k = 0; k < size; k += kTile) {
    const Eigen::Index width = std::min(kTile, size - k), below = size - k - width;
    Eigen::MatrixXd corner = a.block(k, k, width, width);
    const Eigen::LLT<Eigen::MatrixXd> factor(corner);
    if (factor.info() != Eigen::Success) return false;
    const Eigen::MatrixXd l = factor.matrixL();
    a.block(k, k, width, width).triangularView<Eigen::Lower>() = l;
    const auto tiles = std::size_t((below + kTile - 1) / kTile);
    const auto rows_of = [&](std::size_t t) {
      const Eigen::Index first = k + width + Eigen::Index(t) * kTile;
      return std::pair(first, std::min(kTile, size - first));
    };
    parallel_for(tiles, threads, [&](std::size_t t) {
      const auto [first, rows] = rows_of(t);
      auto panel = a.block(first, k, rows, width);
      l.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(panel);
    });
    // Tiles of the trailing lower triangle, each by itself.
    std::vector<std::pair<std::size_t, std::size_t>> trailing;
    for (std::size_t i = 0; i < tiles; ++i)
      for (std::size_t j = 0; j <= i; ++j) trailing.emplace_back(i, j);
    parallel_for(trailing.size(), threads, [&](std::size_t t) {
      const auto [first_i, rows_i] = rows_of(trailing[t].first);
      const auto [first_j, rows_j] = rows_of(trailing[t].second);
      a.block(first_i, first_j, rows_i, rows_j).noalias() -=
          a.block(first_i, k, rows_i, width) * a.block(first_j, k, rows_j, width).transpose();
    });
  }
  return true;
}

void cholesky_solve(std::span<const double> factor, std::size_t n, std::span<double> right,
                    std::size_t columns, int threads) {
  const auto size = Eigen::Index(n), width = Eigen::Index(columns);
  const Eigen::Map<const Eigen::MatrixXd> l(factor.data(), size, size);
  Eigen::Map<RowMatrix> x(right.data(), size, width);
  parallel_for(std::size_t((width + kColumns - 1) / kColumns), threads, [&](std::size_t t) {
    const Eigen::Index first = Eigen::Index(t) * kColumns;
    const Eigen::Index count = std::min(kColumns, width - first);
    Eigen::MatrixXd part = x.middleCols(first, count);
    l.triangularView<Eigen::Lower>().solveInPlace(part);
    l.triangularView<Eigen::Lower>().transpose().solveInPlace(part);
    x.middleCols(first, count) = part;
  });
}

}  // namespace animeme::dam
