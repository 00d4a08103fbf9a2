// Faces to visemes.
#include "fap/viseme.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "fap/detail/bounded_fit.h"
#include "fap/tables.h"
#include "tests/fap/make.h"

namespace animeme::fap {
namespace viseme_test {

using internal::BoundedFit;
using internal::FapValues;
using internal::ShapeWeight;
using made::Random;

double sum_of(const VisemeWeights& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

// The face of a mixture, times `factor`.
Frame mixture(const VisemeWeights& weights, double factor = 1) {
  Frame frame;
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (!viseme_shape(1).mask[std::size_t(fap)]) continue;
    double value = 0;
    for (int v = 0; v < kVisemeCount; ++v) {
      value += factor * weights[std::size_t(v)] * viseme_shape(v).value[std::size_t(fap)];
    }
    frame.set(fap, std::int32_t(std::lround(value)));
  }
  return frame;
}

TEST(Viseme, CodedVisemesAreExact) {
  const VisemeWeights weights = coded_viseme({10, 1, 42, false});
  EXPECT_DOUBLE_EQ(weights[10], 42.0 / 63);
  EXPECT_DOUBLE_EQ(weights[1], 21.0 / 63);
  EXPECT_DOUBLE_EQ(sum_of(weights), 1);
  EXPECT_DOUBLE_EQ(coded_viseme({3, 3, 5, false})[3], 1);
  EXPECT_DOUBLE_EQ(coded_viseme({99, -4, 1000, false})[0], 1);
  Frame frame = mixture(coded_viseme({14, 0, 63, false}));
  frame.mask.set(1);
  frame.viseme = {10, 1, 42, false};
  EXPECT_EQ(VisemeFitter().fit(frame), weights) << "FAP 1 counts more than the lips";
}

TEST(Viseme, ShapesAreSymmetricAndSilenceIsStill) {
  for (int v = 0; v < kVisemeCount; ++v) {
    const Frame& shape = viseme_shape(v);
    EXPECT_EQ(shape.mask.count(), 21U);
    for (const FapInfo& fap : kFaps) {
      if (fap.mirror == 0) continue;
      EXPECT_EQ(shape.value[std::size_t(fap.number)], shape.value[std::size_t(fap.mirror)]);
    }
  }
  EXPECT_EQ(viseme_shape(0), viseme_shape(15));
  EXPECT_EQ(viseme_shape(0), viseme_shape(-1));
  for (const std::int32_t value : viseme_shape(0).value) EXPECT_EQ(value, 0);
}

// The shapes of visemes that lips tell apart are found as what they are; all are found as a face.
TEST(Viseme, ShapesAreFound) {
  for (int v = 1; v < kVisemeCount; ++v) {
    VisemeWeights given{};
    given[std::size_t(v)] = 1;
    const Frame face = mixture(given);
    const VisemeWeights found = VisemeFitter().fit(face);
    EXPECT_NEAR(sum_of(found), 1, 1e-9);
    const Frame shown = mixture(found);
    double error = 0;
    double power = 0;
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      const double value = face.value[std::size_t(fap)];
      error += std::pow(value - shown.value[std::size_t(fap)], 2);
      power += value * value;
    }
    EXPECT_LT(std::sqrt(error / power), 0.15) << kVisemes[std::size_t(v)].name;
    if (v == 1 || v == 2 || v == 7 || v == 11 || v == 13) {
      EXPECT_GT(found[std::size_t(v)], 0.4) << kVisemes[std::size_t(v)].name;
    }
  }
}

TEST(Viseme, LargeMotionEndsAtTheVisemeThatGoesFarthest) {
  VisemeWeights given{};
  given[11] = 1;
  const VisemeWeights found = VisemeFitter().fit(mixture(given, 4));
  EXPECT_NEAR(sum_of(found), 1, 1e-9);
  EXPECT_GT(found[11], 0.9);
  EXPECT_NEAR(found[0], 0, 1e-6);
}

TEST(Viseme, AFaceAtRestIsSilent) {
  EXPECT_EQ(VisemeFitter().fit(Frame{})[0], 1);
  EXPECT_EQ(VisemeFitter().fit(viseme_shape(0))[0], 1);
  Frame brows;
  brows.set(31, 300);
  brows.set(48, 20000);
  EXPECT_EQ(VisemeFitter().fit(brows)[0], 1);
}

TEST(Viseme, AnyNumbersStayWithinBounds) {
  Random random(3);
  VisemeFitter fitter;
  for (int round = 0; round < 100; ++round) {
    Frame frame;
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (random.chance(70)) frame.set(fap, std::int32_t(random.in(INT32_MIN, INT32_MAX)));
    }
    const VisemeWeights found = fitter.fit(frame);
    EXPECT_NEAR(sum_of(found), 1, 1e-9);
    for (const double weight : found) EXPECT_TRUE(weight >= 0 && weight <= 1) << weight;
  }
}

// No other weights within the bounds and the limit are nearer to the face.
TEST(BoundedFit, NothingElseIsNearer) {
  Random random(8);
  for (int round = 0; round < 30; ++round) {
    std::vector<std::vector<ShapeWeight>> shapes(5);
    for (auto& shape : shapes) {
      for (const int fap : {3, 4, 5, 51, 52, 59}) {
        shape.push_back({fap, std::int32_t(random.in(-500, 500))});
      }
    }
    Mask mask;
    FapValues target{};
    for (const int fap : {3, 4, 5, 51, 52, 59}) {
      mask.set(std::size_t(fap));
      target[std::size_t(fap)] = double(random.in(-1500, 1500));
    }
    const double most = round % 2 == 0 ? 1 : 10;
    BoundedFit fit(shapes, 0, 0, most);
    const std::vector<double> found = fit.fit(mask, target);
    // All of these FAPs have the same unit.
    const auto distance = [&](const std::vector<double>& weights) {
      double sum = 0;
      for (std::size_t f = 0; f < 6; ++f) {
        double left = target[std::size_t(shapes[0][f].fap)];
        for (std::size_t s = 0; s < shapes.size(); ++s) left -= weights[s] * shapes[s][f].value;
        sum += left * left;
      }
      return sum;
    };
    const double best = distance(found);
    EXPECT_LE(std::accumulate(found.begin(), found.end(), 0.0), most + 1e-9);
    for (int attempt = 0; attempt < 2000; ++attempt) {
      std::vector<double> other = found;
      const bool near = attempt % 2 == 0;
      for (double& weight : other) {
        const double step = double(random.in(-1000, 1000)) * (near ? 1e-5 : 1e-3);
        weight = std::clamp(weight + step, 0.0, 1.0);
      }
      if (std::accumulate(other.begin(), other.end(), 0.0) > most) continue;
      ASSERT_GE(distance(other), best - 1e-3 * (1 + best)) << round;
    }
  }
}

// Two shapes side by side whose weights may be 1 together: the nearest face within that limit takes
// the same off both.
TEST(BoundedFit, TheNearestFaceWithinALimitOfTheSum) {
  const auto fit = [](double left, double right) {
    internal::BoundedFit fitter({{{6, 1000}}, {{7, 1000}}}, 0, 0, 1);
    internal::FapValues target{};
    target[6] = 1000 * left;
    target[7] = 1000 * right;
    Mask mask;
    mask.set(6);
    mask.set(7);
    return fitter.fit(mask, target);
  };
  const double cases[][4] = {{0.8, 0.8, 0.5, 0.5},
                             {0.9, 0.5, 0.7, 0.3},
                             {1, 0.1, 0.95, 0.05},
                             {0.4, 0.5, 0.4, 0.5},
                             {0.2, 0.95, 0.125, 0.875}};
  for (const auto& [left, right, first, second] : cases) {
    const std::vector<double> weights = fit(left, right);
    EXPECT_NEAR(weights[0], first, 1e-3) << left << " " << right;
    EXPECT_NEAR(weights[1], second, 1e-3) << left << " " << right;
    EXPECT_LE(weights[0] + weights[1], 1 + 1e-9);
  }
}

}  // namespace viseme_test
}  // namespace animeme::fap
