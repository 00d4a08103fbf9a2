// The two steps of the fit against signals whose truth is known.
#include "dam/kinds/animeme/fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dam/model/animeme.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace fit_test {

using test::Planted;
using test::Uniform;

/// A small problem: one mode per phone, random target.
FitData random_problem(Uniform& random, std::size_t controls, int order, bool normalised) {
  FitData data;
  data.normalised = normalised;
  data.controls = controls;
  data.order = order;
  data.rate = 40;
  for (std::size_t s = 0; s < 3; ++s) {
    FitSentence sentence{data.use.size(), 60, data.occurrences.size(), 9};
    double t = 0.1;
    for (std::size_t j = 0; j < sentence.occurrences; ++j) {
      const auto phone = std::int32_t(random.below(4));
      const double d = random(0.05, 0.2);
      data.occurrences.push_back({t, d, phone, 0, 0, std::uint32_t(phone)});
      t += d;
    }
    for (std::size_t i = 0; i < sentence.frames; ++i) {
      data.use.push_back(i % 17 == 3 ? 0 : 1);
      for (std::size_t c = 0; c < controls; ++c) data.target.push_back(random(-1, 1));
    }
    data.sentences.push_back(sentence);
  }
  return data;
}

double squared_error(const FitData& data, const FitState& state) {
  double sum = 0;
  for (const FitSentence& s : data.sentences) {
    const auto fitted = predict(data, state, s, make_design(data, s, state.sigma));
    for (std::size_t i = 0; i < s.frames; ++i)
      for (std::size_t c = 0; data.use[s.first_frame + i] != 0 && c < data.controls; ++c) {
        const double r =
            data.target[(s.first_frame + i) * data.controls + c] - fitted[i * data.controls + c];
        sum += r * r;
      }
  }
  return sum;
}

TEST(Dominance, IsEquationOne) {
  EXPECT_EQ(dominance(0, 0.5), 1);
  EXPECT_EQ(dominance(1, 0.5), 1);
  EXPECT_EQ(dominance(0.3, 0.5), 1);
  EXPECT_NEAR(dominance(-0.5, 0.5), std::exp(-1), 1e-5);
  EXPECT_NEAR(dominance(2.0, 0.5), std::exp(-4), 1e-5);
  EXPECT_NEAR(dominance(1 + dominance_reach(0.7), 0.7), kDominanceCut, 1e-12);
  const double h = 1e-6, log_sigma = std::log(0.6);
  for (const double u : {-0.8, 0.5, 1.4})
    EXPECT_NEAR(
        dominance_slope(u, 0.6),
        (dominance(u, std::exp(log_sigma + h)) - dominance(u, std::exp(log_sigma - h))) / (2 * h),
        1e-8);
}

TEST(Legendre, BecomesPowersOfLocalTime) {
  const std::vector<double> series = {0.3, -1.2, 0.7, 0.1, -0.4};
  const auto powers = power_coefficients(series);
  for (const double u : {-0.5, 0.0, 0.21, 1.0, 1.5, 3.0}) {
    double basis[5], sum = 0;
    legendre(u, 10, 4, basis);
    for (std::size_t m = 0; m < 5; ++m) sum += series[m] * basis[m];
    EXPECT_NEAR(polynomial(powers, u), sum, 1e-10 * (1 + std::abs(sum)));
  }
}

/// Both blends: the plain sum (false) and the normalised one (true).
class Blend : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Both, Blend, testing::Bool());

TEST_P(Blend, EStepIsAMinimum) {
  Uniform random(3);
  const FitData data = random_problem(random, 3, 2, GetParam());
  FitWeights weights{0, 0, 1};
  FitState state;
  state.sigma = {0.6, 0.8, 1.0, 0.5};
  solve_coefficients(data, weights, state);
  EXPECT_NEAR(state.objective, squared_error(data, state), 1e-6 * state.objective);
  for (std::size_t i = 0; i < state.coefficients.size(); ++i)
    for (const double step : {-1e-3, 1e-3}) {
      FitState moved = state;
      moved.coefficients[i] += step;
      EXPECT_GE(squared_error(data, moved), state.objective * (1 - 1e-9));
    }
}

TEST_P(Blend, GradientAndJacobianMatchFiniteDifferences) {
  Uniform random(4);
  const FitData data =
      random_problem(random, 11, 3, GetParam());  // more than one block of controls
  FitWeights weights{1, 0, 1};
  FitState state;
  state.sigma = {0.6, 0.8, 1.0, 0.5};
  solve_coefficients(data, weights, state);
  const WidthStep step = width_step(data, weights, state, false);
  const double h = 1e-6;
  // Jacobian of the prediction by central differences, coefficients fixed (Eq. 8).
  std::vector<std::vector<double>> jacobian(4);
  for (std::size_t g = 0; g < 4; ++g)
    for (const FitSentence& s : data.sentences) {
      FitState up = state, down = state;
      up.sigma[g] *= std::exp(h);
      down.sigma[g] *= std::exp(-h);
      const auto a = predict(data, up, s, make_design(data, s, up.sigma));
      const auto b = predict(data, down, s, make_design(data, s, down.sigma));
      for (std::size_t i = 0; i < a.size(); ++i)
        jacobian[g].push_back(
            data.use[s.first_frame + i / data.controls] != 0 ? (a[i] - b[i]) / (2 * h) : 0.0);
    }
  for (std::size_t g = 0; g < 4; ++g) {
    FitState up = state, down = state;
    up.sigma[g] *= std::exp(h);
    down.sigma[g] *= std::exp(-h);
    const double slope = (squared_error(data, up) - squared_error(data, down)) / (2 * h);
    EXPECT_NEAR(step.gradient[g], -slope / 2, 1e-3 * (1 + std::abs(slope)));
    for (std::size_t k = 0; k < 4; ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < jacobian[g].size(); ++i) sum += jacobian[g][i] * jacobian[k][i];
      EXPECT_NEAR(step.hessian[g * 4 + k], sum, 1e-2 * (1 + std::abs(sum)));
    }
  }
}

TEST_P(Blend, ProjectionLowersTheHessianAndKeepsTheGradient) {
  Uniform random(5);
  const FitData data = random_problem(random, 3, 2, GetParam());
  FitWeights weights{1, 0, 1};
  FitState state;
  state.sigma = {0.6, 0.8, 1.0, 0.5};
  solve_coefficients(data, weights, state);
  const WidthStep plain = width_step(data, weights, state, false);
  const WidthStep projected = width_step(data, weights, state, true);
  for (std::size_t g = 0; g < 4; ++g) {
    EXPECT_DOUBLE_EQ(plain.gradient[g], projected.gradient[g]);
    EXPECT_LT(projected.hessian[g * 5], plain.hessian[g * 5]);
    EXPECT_GT(projected.hessian[g * 5], 0);
  }
}

TEST_P(Blend, ObjectiveNeverRises) {
  Uniform random(6);
  const FitData data = random_problem(random, 2, 4, GetParam());
  const FitWeights weights{1, 1, 1};
  FitState state;
  state.sigma.assign(4, 1.0);
  solve_coefficients(data, weights, state);
  double last = state.objective;
  int steps = 0;
  expectation_maximisation(data, weights, 50, 1e-9, state, [&](const FitState& now) {
    EXPECT_LT(now.objective, last);
    last = now.objective;
    return ++steps < 40;
  });
  EXPECT_GT(steps, 1);
}

/// The planted signal as a problem of the fit, one mode per phone.
FitData planted_problem(Uniform& random, const Planted& planted, std::size_t count,
                        bool normalised) {
  FitData data;
  data.normalised = normalised;
  data.controls = planted.coefficients[0].size();
  data.order = int(planted.coefficients[0][0].size()) - 1;
  data.rate = 50;
  for (const Utterance& u : test::planted_sentences(random, planted, count, 0.5, normalised)) {
    const auto timeline = make_timeline(u.script, 0.3);
    data.sentences.push_back(
        {data.use.size(), u.signal.frames(), data.occurrences.size(), timeline.size()});
    // As in training: long pauses, which no phone reaches, are left out.
    const auto speech = speech_stretches(u.script);
    for (std::size_t i = 0; i < u.signal.frames(); ++i)
      data.use.push_back(distance_to_speech(speech, double(i) / data.rate) < 0.3 ? 1 : 0);
    data.target.insert(data.target.end(), u.signal.values.begin(), u.signal.values.end());
    for (const Occurrence& o : timeline) {
      const auto p =
          std::uint32_t(std::find(planted.labels.begin(), planted.labels.end(), o.label) -
                        planted.labels.begin());
      data.occurrences.push_back({o.start, o.duration, std::int32_t(p), 0, 0, p});
    }
  }
  return data;
}

TEST_P(Blend, RecoversPlantedPolynomialsAndWidths) {
  Uniform random(7);
  const Planted planted = test::plant(random, {"SIL", "AA", "B", "IY", "S"}, 3, 3);
  const FitData data = planted_problem(random, planted, 40, GetParam());
  FitWeights weights{0, 0, 1};
  FitState state;
  state.sigma.assign(5, 1.0);
  solve_coefficients(data, weights, state);
  const double before = state.objective;
  expectation_maximisation(data, weights, 100, 1e-14, state, [](const FitState&) { return true; });
  EXPECT_LT(state.objective, 1e-6 * before);
  for (std::size_t p = 0; p < planted.labels.size(); ++p) {
    EXPECT_NEAR(state.sigma[p], planted.sigma[p], 1e-3) << planted.labels[p];
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<double> series(3);
      for (std::size_t m = 0; m < 3; ++m) series[m] = state.coefficients[(p * 3 + m) * 3 + c];
      const auto powers = power_coefficients(series);
      for (std::size_t m = 0; m < 3; ++m)
        EXPECT_NEAR(powers[m], planted.coefficients[p][c][m], 1e-2) << planted.labels[p];
    }
  }
}

}  // namespace fit_test
}  // namespace animeme::dam
