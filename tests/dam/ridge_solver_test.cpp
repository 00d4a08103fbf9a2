// Solutions of large normal equations against plain linear algebra.
#include "dam/maths/ridge_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "dam/maths/tile_product.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace ridge_solver_test {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

TEST(TileProduct, SumsInTheOrderOfItsDepth) {
  test::Uniform random(5);
  constexpr std::size_t kRows = 2 * kTileRows, kColumns = 2 * kTileColumns, kDepth = 37;
  std::vector<float> x(kRows * kDepth), b(kColumns * kDepth), c(kRows * kColumns);
  for (auto* list : {&x, &b, &c})
    for (float& value : *list) value = float(random(-1, 1));
  for (const bool turned : {false, true}) {
    const std::size_t step = turned ? kDepth : 1, stride = turned ? 1 : kColumns;
    std::vector<float> got = c;
    subtract_tile_product(got.data(), kRows, x.data(), kRows, {b.data(), step, stride}, kRows,
                          kColumns, kDepth);
    for (std::size_t i = 0; i < kColumns; ++i)
      for (std::size_t r = 0; r < kRows; ++r) {
        float sum = 0;
        for (std::size_t p = 0; p < kDepth; ++p) sum += x[r + p * kRows] * b[i * step + p * stride];
        EXPECT_EQ(got[r + i * kRows], c[r + i * kRows] - sum);
      }
  }
}

struct System {
  LowerTriangle a;
  Eigen::MatrixXd full;
  RowMatrix right;

  /// Of rank `rank`, so that the ridge alone keeps it solvable.
  System(Eigen::Index n, Eigen::Index rank, test::Uniform& random) : a(std::size_t(n)) {
    Eigen::MatrixXd rows(n, rank);
    for (Eigen::Index i = 0; i < rows.size(); ++i) rows.data()[i] = random(-3, 3);
    full = rows * rows.transpose();
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = j; i < n; ++i) a.at(std::size_t(i), std::size_t(j)) = full(i, j);
    right = RowMatrix(n, 5);
    for (Eigen::Index i = 0; i < right.size(); ++i) right.data()[i] = random(-1, 1);
  }
  RowMatrix solution(std::span<const double> ridge) const {
    Eigen::MatrixXd matrix = full;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) matrix(i, i) += ridge[std::size_t(i)];
    return matrix.llt().solve(right);
  }
};

TEST(RidgeSolver, OneFactorSolvesForSeveralRidges) {
  test::Uniform random(6);
  for (const Eigen::Index n : {1, 5, 192, 193, 450}) {
    const System system(n, n / 2 + 1, random);
    std::vector<double> usual;
    for (Eigen::Index i = 0; i < n; ++i) usual.push_back(random(0.2, 5));
    std::vector<double> first;
    for (const int threads : {1, 3}) {
      const RidgeSolver solver(system.a, usual, threads);
      ASSERT_TRUE(solver.ok());
      std::vector<double> x(std::size_t(n) * 5);
      for (const double factor : {1.0, 2.0, 0.5}) {
        std::vector<double> ridge = usual;
        for (double& r : ridge) r *= factor;
        // Each starts from the solution before.
        ASSERT_TRUE(solver.solve(ridge, {system.right.data(), std::size_t(n) * 5}, 5, 1e-10, x));
        const RowMatrix want = system.solution(ridge);
        for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], want.data()[i], 1e-7);
      }
      if (threads == 1) first = x;
      EXPECT_EQ(x, first);
    }
  }
}

TEST(RidgeSolver, NearlySingularSumsTakeMoreSteps) {
  test::Uniform random(7);
  const System system(300, 20, random);
  const std::vector<double> ridge(300, 1e-6);  // of squares of about 60
  const RidgeSolver solver(system.a, ridge, 1);
  ASSERT_TRUE(solver.ok());
  std::vector<double> x(300 * 5);
  EXPECT_TRUE(solver.solve(ridge, {system.right.data(), x.size()}, 5, 1e-8, x));
  const RowMatrix want = system.solution(ridge);
  double error = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    error += (x[i] - want.data()[i]) * (x[i] - want.data()[i]);
  EXPECT_LT(error, 1e-6 * want.squaredNorm());
}

TEST(RidgeSolver, WhatHasNoSolutionIsNotSolved) {
  LowerTriangle bad(2);
  bad.at(0, 0) = bad.at(1, 1) = 1;
  bad.at(1, 0) = 2;
  const std::vector<double> none(2, 0.0), right(2, 1.0);
  const RidgeSolver solver(bad, none, 1);
  EXPECT_FALSE(solver.ok());
  std::vector<double> x(2);
  EXPECT_FALSE(solver.solve(none, right, 1, 1e-8, x));
}

}  // namespace ridge_solver_test
}  // namespace animeme::dam
