#include "dam/maths/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Index kTile = 192;
constexpr Index kColumns = 16;  // right sides solved by one task

Eigen::Map<Matrix> columns_of(std::span<double> values, std::size_t rows) {
  return {values.data(), Index(rows), Index(rows == 0 ? 0 : values.size() / rows)};
}
Eigen::Map<const Matrix> columns_of(std::span<const double> values, std::size_t rows) {
  return {values.data(), Index(rows), Index(rows == 0 ? 0 : values.size() / rows)};
}
Eigen::Map<RowMatrix> rows_of(std::span<double> values, std::size_t rows) {
  return {values.data(), Index(rows), Index(rows == 0 ? 0 : values.size() / rows)};
}
Eigen::Map<const RowMatrix> rows_of(std::span<const double> values, std::size_t rows) {
  return {values.data(), Index(rows), Index(rows == 0 ? 0 : values.size() / rows)};
}

}  // namespace

std::vector<double> column_sums(std::span<const double> rows, std::size_t columns) {
  std::vector<double> sums(columns);
  Eigen::Map<Eigen::RowVectorXd>(sums.data(), Index(columns)) =
      rows_of(rows, rows.size() / columns).colwise().sum();
  return sums;
}

bool cholesky(std::span<double> matrix, std::size_t n) {
  Eigen::Map<Matrix> a = columns_of(matrix, n);
  const Eigen::LLT<Matrix> factor(a);
  a = factor.matrixLLT();
  return factor.info() == Eigen::Success;
}

void cholesky_solve(std::span<const double> factor, std::size_t n, std::span<double> right,
                    std::size_t columns) {
  const Eigen::Map<const Matrix> l = columns_of(factor, n);
  Eigen::Map<RowMatrix> x(right.data(), Index(n), Index(columns));
  l.triangularView<Eigen::Lower>().solveInPlace(x);
  l.triangularView<Eigen::Lower>().transpose().solveInPlace(x);
}

bool cholesky_in_place(std::span<double> matrix, std::size_t n, int threads) {
  const auto size = Index(n);
  Eigen::Map<Matrix> a = columns_of(matrix, n);
  for (Index k = 0; k < size; k += kTile) {
    const Index width = std::min(kTile, size - k), below = size - k - width;
    const Matrix corner = a.block(k, k, width, width);
    const Eigen::LLT<Matrix> factor(corner);
    if (factor.info() != Eigen::Success) return false;
    const Matrix l = factor.matrixL();
    a.block(k, k, width, width).triangularView<Eigen::Lower>() = l;
    const auto tiles = std::size_t((below + kTile - 1) / kTile);
    const auto rows_of_tile = [&](std::size_t t) {
      const Index first = k + width + Index(t) * kTile;
      return std::pair(first, std::min(kTile, size - first));
    };
    parallel_for(tiles, threads, [&](std::size_t t) {
      const auto [first, rows] = rows_of_tile(t);
      auto panel = a.block(first, k, rows, width);
      l.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(panel);
    });
    // Tiles of the trailing lower triangle, each by itself.
    std::vector<std::pair<std::size_t, std::size_t>> trailing;
    for (std::size_t i = 0; i < tiles; ++i)
      for (std::size_t j = 0; j <= i; ++j) trailing.emplace_back(i, j);
    parallel_for(trailing.size(), threads, [&](std::size_t t) {
      const auto [first_i, rows_i] = rows_of_tile(trailing[t].first);
      const auto [first_j, rows_j] = rows_of_tile(trailing[t].second);
      a.block(first_i, first_j, rows_i, rows_j).noalias() -=
          a.block(first_i, k, rows_i, width) * a.block(first_j, k, rows_j, width).transpose();
    });
  }
  return true;
}

void cholesky_solve(std::span<const double> factor, std::size_t n, std::span<double> right,
                    std::size_t columns, int threads) {
  const auto width = Index(columns);
  const Eigen::Map<const Matrix> l = columns_of(factor, n);
  Eigen::Map<RowMatrix> x(right.data(), Index(n), width);
  parallel_for(std::size_t((width + kColumns - 1) / kColumns), threads, [&](std::size_t t) {
    const Index first = Index(t) * kColumns;
    const Index count = std::min(kColumns, width - first);
    Matrix part = x.middleCols(first, count);
    l.triangularView<Eigen::Lower>().solveInPlace(part);
    l.triangularView<Eigen::Lower>().transpose().solveInPlace(part);
    x.middleCols(first, count) = part;
  });
}

void solve_lower(std::span<const double> factor, std::size_t n, std::span<double> right,
                 std::size_t columns) {
  Eigen::Map<Matrix> x(right.data(), Index(n), Index(columns));
  columns_of(factor, n).triangularView<Eigen::Lower>().solveInPlace(x);
}

std::vector<double> solve_symmetric(std::span<const double> matrix, std::span<const double> right) {
  std::vector<double> solution(right.size());
  const Eigen::LDLT<Matrix> factor(columns_of(matrix, right.size()));
  Eigen::Map<Eigen::VectorXd>(solution.data(), Index(right.size())) =
      factor.solve(Eigen::Map<const Eigen::VectorXd>(right.data(), Index(right.size())));
  return solution;
}

std::vector<double> solve_symmetric(std::span<const double> matrix, std::size_t n,
                                    std::span<const double> right, std::size_t columns) {
  std::vector<double> solution(n * columns);
  const Eigen::LDLT<Matrix> factor(columns_of(matrix, n));
  rows_of(std::span<double>(solution), n) = factor.solve(rows_of(right, n));
  return solution;
}

Eigenvectors symmetric_eigenvectors(std::span<const double> matrix, std::size_t n) {
  // As SelfAdjointEigenSolver does it, which would compile the reflections of large matrices by
  // blocks as well, though it never uses them: a third of the time of this file.
  Matrix a = columns_of(matrix, n).triangularView<Eigen::Lower>();
  const double most = a.cwiseAbs().maxCoeff(), scale = most == 0 ? 1 : most;
  a.triangularView<Eigen::Lower>() /= scale;
  const Eigen::Tridiagonalization<Matrix> tridiagonal(a);
  Eigen::VectorXd values = tridiagonal.diagonal(), beside = tridiagonal.subDiagonal();
  const Eigen::VectorXd shares = tridiagonal.householderCoefficients();
  const Matrix& reflections = tridiagonal.packedMatrix();
  Matrix vectors = Matrix::Identity(Index(n), Index(n));
  Eigen::VectorXd work(n);
  for (Index k = Index(n) - 2; k >= 0; --k) {
    const Index size = Index(n) - k - 1;
    vectors.bottomRightCorner(size, size)
        .applyHouseholderOnTheLeft(reflections.col(k).tail(size - 1), shares[k], work.data());
  }
  constexpr Index kMostIterations = 30;  // for each value; a few are usual
  Eigen::internal::computeFromTridiagonal_impl(values, beside, kMostIterations, true, vectors);
  values *= scale;
  return {{values.data(), values.data() + n}, {vectors.data(), vectors.data() + n * n}};
}

void subtract_gram(std::span<const double> b, std::size_t rows, std::size_t n, double scale,
                   std::span<double> gram) {
  const Eigen::Map<const Matrix> columns = columns_of(b, rows);
  columns_of(gram, n).noalias() -= scale * columns.transpose() * columns;
}

void subtract_product(std::span<const double> a, std::span<const double> x, double scale,
                      std::span<double> out) {
  const Eigen::Map<const Eigen::RowVectorXd> row(x.data(), Index(x.size()));
  Eigen::Map<Eigen::VectorXd>(out.data(), Index(out.size())).noalias() -=
      scale * rows_of(a, out.size()) * row.transpose();
}

}  // namespace animeme::dam
