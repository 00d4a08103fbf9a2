#include "dam/crossmap/bounded_least_squares.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "dam/maths/random.h"

namespace animeme::dam {
namespace bounded_least_squares_test {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

// The algorithm NNLS as the book has it (Lawson and Hanson, chapter 23): each step solves the free
// columns by an orthogonal decomposition of the matrix itself. Slow, and nothing is kept.
Vector textbook(const Matrix& a, const Vector& b) {
  const auto n = a.cols();
  Vector x = Vector::Zero(n);
  std::vector<bool> passive(std::size_t(n), false);
  const auto solve = [&] {
    std::vector<Eigen::Index> set;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (passive[std::size_t(j)]) set.push_back(j);
    }
    Vector z = Vector::Zero(n);
    if (set.empty()) return z;
    Matrix part(a.rows(), Eigen::Index(set.size()));
    for (std::size_t k = 0; k < set.size(); ++k) part.col(Eigen::Index(k)) = a.col(set[k]);
    const Vector y = part.completeOrthogonalDecomposition().solve(b);
    for (std::size_t k = 0; k < set.size(); ++k) z[set[k]] = y[Eigen::Index(k)];
    return z;
  };
  for (int round = 0; round < 10 * int(n); ++round) {
    const Vector w = a.transpose() * (b - a * x);
    Eigen::Index best = -1;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (passive[std::size_t(j)] || w[j] <= 1e-13 * a.col(j).norm() * b.norm()) continue;
      if (best < 0 || w[j] > w[best]) best = j;
    }
    if (best < 0) break;
    passive[std::size_t(best)] = true;
    Vector z = solve();
    while (true) {
      double step = 2;
      for (Eigen::Index j = 0; j < n; ++j) {
        if (passive[std::size_t(j)] && z[j] <= 0) step = std::min(step, x[j] / (x[j] - z[j]));
      }
      if (step > 1) break;
      x += step * (z - x);
      for (Eigen::Index j = 0; j < n; ++j) {
        if (passive[std::size_t(j)] && x[j] <= 1e-15 * x.lpNorm<Eigen::Infinity>()) {
          passive[std::size_t(j)] = false;
          x[j] = 0;
        }
      }
      z = solve();
    }
    x = z;
  }
  return x;
}

// About normal: the mean is 0, the deviation 1.
double normal(Random& random) {
  double sum = 0;
  for (int i = 0; i < 12; ++i) sum += random.between(-0.5, 0.5);
  return sum;
}

struct Problem {
  Matrix a;
  Vector b;
};

Problem random_problem(Random& random, Eigen::Index rows, Eigen::Index columns) {
  Problem problem{Matrix(rows, columns), Vector(rows)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) problem.a(i, j) = normal(random);
    problem.b[i] = normal(random);
  }
  return problem;
}

Vector solved(const Problem& problem, const LeastSquaresLimits& limits = {}) {
  BoundedLeastSquares solver({problem.a.data(), std::size_t(problem.a.size())},
                             std::size_t(problem.a.rows()), std::size_t(problem.a.cols()), limits);
  const auto x = solver.fit({problem.b.data(), std::size_t(problem.b.size())});
  return Eigen::Map<const Vector>(x.data(), Eigen::Index(x.size()));
}

TEST(NonNegativeLeastSquares, AgreesWithTheTextbookOnTallProblems) {
  Random random(1);
  for (int round = 0; round < 300; ++round) {
    const Eigen::Index n = 1 + Eigen::Index(random.below(60));
    const Problem problem = random_problem(random, n + 10 + Eigen::Index(random.below(90)), n);
    const Vector x = solved(problem), reference = textbook(problem.a, problem.b);
    ASSERT_GE(x.minCoeff(), 0);
    ASSERT_LE((x - reference).lpNorm<Eigen::Infinity>(), 1e-9) << round;
  }
}

// Where the columns depend on each other, what they make is unique, but not what of them.
TEST(NonNegativeLeastSquares, MakesWhatTheTextbookMakesOfDependentColumns) {
  Random random(2);
  for (int round = 0; round < 300; ++round) {
    const Eigen::Index rows = 2 + Eigen::Index(random.below(40));
    Problem problem = random_problem(random, rows, 1 + Eigen::Index(random.below(60)));
    const Eigen::Index n = problem.a.cols();
    for (int change = 0; change < 4; ++change) {
      const auto j = Eigen::Index(random.below(std::size_t(n)));
      const auto k = Eigen::Index(random.below(std::size_t(n)));
      const auto m = Eigen::Index(random.below(std::size_t(n)));
      if (change == 0) problem.a.col(j).setZero();
      if (change == 1) problem.a.col(j) = problem.a.col(k);
      if (change == 2) problem.a.col(j) = problem.a.col(k) + 2 * problem.a.col(m);
      if (change == 3) problem.a.col(j) *= 1e6;
    }
    if (round % 3 == 0) problem.b = problem.a * Vector::Ones(n);  // within reach
    const Vector x = solved(problem), reference = textbook(problem.a, problem.b);
    ASSERT_GE(x.minCoeff(), 0);
    const double scale = std::max(1.0, problem.b.norm());
    ASSERT_LE((problem.a * (x - reference)).norm() / scale, 1e-9)
        << round << ": " << rows << " x " << n;
  }
}

// At the minimum no unknown can be moved within its limits so that the sum falls.
TEST(BoundedLeastSquares, KeepsTheConditionsOfAMinimum) {
  Random random(3);
  std::size_t low = 0, high = 0, between = 0;
  for (int round = 0; round < 300; ++round) {
    const Eigen::Index n = 1 + Eigen::Index(random.below(52));
    const Problem problem = random_problem(random, n + 5 + Eigen::Index(random.below(60)), n);
    LeastSquaresLimits limits;
    for (Eigen::Index j = 0; j < n; ++j) {
      limits.lows.push_back(normal(random) * 0.1);
      limits.highs.push_back(limits.lows.back() + 0.2 * random.between(0, 1));
    }
    const Vector x = solved(problem, limits);
    const Vector slope = problem.a.transpose() * (problem.a * x - problem.b);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double l = limits.lows[std::size_t(j)], h = limits.highs[std::size_t(j)];
      ASSERT_GE(x[j], l);
      ASSERT_LE(x[j], h + 1e-15);
      if (x[j] == l) {
        ++low;
        ASSERT_GE(slope[j], -1e-9);
      } else if (x[j] >= h - 1e-15) {
        ++high;
        ASSERT_LE(slope[j], 1e-9);
      } else {
        ++between;
        ASSERT_NEAR(slope[j], 0, 1e-9);
      }
    }
  }
  EXPECT_GT(std::min({low, high, between}), 300u);  // all three were seen
}

TEST(BoundedLeastSquares, DoesNotDependOnTheFitBefore) {
  Random random(4);
  const Problem problem = random_problem(random, 126, 52);
  BoundedLeastSquares kept({problem.a.data(), std::size_t(problem.a.size())}, 126, 52, {.high = 1});
  BoundedLeastSquares fresh = kept;
  Vector b = Vector::Zero(126);
  for (int frame = 0; frame < 200; ++frame) {
    for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = 0.9 * b[i] + 2 * normal(random);
    fresh.restart();
    const auto expected = fresh.fit({b.data(), 126});
    const auto x = kept.fit({b.data(), 126});
    for (std::size_t j = 0; j < 52; ++j) ASSERT_NEAR(x[j], expected[j], 1e-12);
  }
}

TEST(BoundedLeastSquares, SumsOfTargetsHaveSumsOfProducts) {
  Random random(5);
  const Problem problem = random_problem(random, 30, 8);
  BoundedLeastSquares solver({problem.a.data(), 240}, 30, 8, {.high = 1});
  const Vector other = random_problem(random, 30, 1).b, sum = 0.3 * problem.b + 1.7 * other;
  const auto p = solver.products({problem.b.data(), 30}), q = solver.products({other.data(), 30});
  std::vector<double> mixed(8);
  for (std::size_t j = 0; j < 8; ++j) mixed[j] = 0.3 * p[j] + 1.7 * q[j];
  const auto a = solver.fit({sum.data(), 30});
  const std::vector<double> expected(a.begin(), a.end());
  const auto b = solver.fit_products(mixed);
  for (std::size_t j = 0; j < 8; ++j) EXPECT_NEAR(b[j], expected[j], 1e-12);
}

TEST(BoundedLeastSquares, ARidgeSharesBetweenColumnsThatDoTheSame) {
  const std::vector<double> a = {1, 1, 1, 1};  // two rows, two equal columns
  const std::vector<double> b = {1, 1};
  BoundedLeastSquares plain(a, 2, 2), ridged(a, 2, 2, {.ridge = 0.01});
  const auto one = plain.fit(b);
  EXPECT_NEAR(one[0] + one[1], 1, 1e-12);
  const auto shared = ridged.fit(b);
  EXPECT_NEAR(shared[0], shared[1], 1e-12);
  EXPECT_NEAR(shared[0], 1 / 2.01, 1e-12);
}

TEST(BoundedLeastSquares, NothingToFitIsNoTrouble) {
  BoundedLeastSquares none({}, 0, 3);
  EXPECT_THAT(none.fit({}), testing::ElementsAre(0, 0, 0));
  const std::vector<double> zeros(6, 0.0);
  BoundedLeastSquares zero(zeros, 3, 2, {.low = 0.25, .high = 1});
  const std::vector<double> b = {1, 2, 3};
  EXPECT_THAT(zero.fit(b), testing::ElementsAre(0.25, 0.25));
}

}  // namespace bounded_least_squares_test
}  // namespace animeme::dam
