#include "dam/maths/affinity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "dam/maths/spline.h"

namespace animeme::dam {
namespace affinity_test {

using testing::Each;
using testing::ElementsAre;

std::vector<double> negative_squared_distances(const std::vector<double>& x) {
  std::vector<double> s;
  for (const double a : x)
    for (const double b : x) s.push_back(-(a - b) * (a - b));
  return s;
}

TEST(AffinityPropagation, FindsThreeHeapsOnALine) {
  // Exemplars must be the points in the middle of each heap.
  const std::vector<double> x = {0, 1, 2, 20, 21, 22, 23, 24, 50, 51, 52};
  const auto clusters = affinity_propagation(negative_squared_distances(x), -30);
  EXPECT_TRUE(clusters.converged);
  EXPECT_THAT(clusters.exemplars, ElementsAre(1u, 5u, 9u));
  EXPECT_THAT(clusters.label, ElementsAre(0u, 0u, 0u, 1u, 1u, 1u, 1u, 1u, 2u, 2u, 2u));
}

TEST(AffinityPropagation, PreferenceDecidesHowMany) {
  const std::vector<double> x = {0, 1, 2, 20, 21, 22, 23, 24, 50, 51, 52};
  const auto s = negative_squared_distances(x);
  EXPECT_EQ(affinity_propagation(s, -1e6).exemplars.size(), 1u);
  EXPECT_EQ(affinity_propagation(s, 0).exemplars.size(), x.size());
}

TEST(AffinityPropagation, MatchesTheBestOfAllChoicesOfExemplars) {
  // Net similarity: sum of similarities to the own exemplar plus the preferences of exemplars.
  const std::vector<double> x = {0, 0.7, 3.1, 3.9, 4.1, 9.0, 9.6, 14.2};
  const auto s = negative_squared_distances(x);
  const double preference = -8;
  const auto net_similarity = [&](unsigned set) {
    double net = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      double nearest = (set >> i & 1) != 0 ? preference : -1e300;
      for (std::size_t k = 0; (set >> i & 1) == 0 && k < 8; ++k)
        if ((set >> k & 1) != 0) nearest = std::max(nearest, s[i * 8 + k]);
      net += nearest;
    }
    return net;
  };
  double best = -1e300;
  for (unsigned set = 1; set < 256; ++set) best = std::max(best, net_similarity(set));
  unsigned found = 0;
  for (const std::size_t k : affinity_propagation(s, preference).exemplars) found |= 1u << k;
  EXPECT_NEAR(net_similarity(found), best, 1e-9);
}

TEST(AffinityPropagation, FiveParticipantsOfAPublishedExample) {
  // The worked example of Thavikulwat, "Affinity propagation: a clustering algorithm for
  // computer-assisted business simulations and experiential exercises", 2008: the answers of
  // five people to five questions; the preference is the least similarity. The first three belong
  // together, and so do the last two.
  const double answers[5][5] = {
      {3, 4, 3, 2, 1}, {4, 3, 5, 1, 1}, {3, 5, 3, 3, 3}, {2, 1, 3, 3, 2}, {1, 1, 3, 2, 3}};
  std::vector<double> similarity;
  for (const auto& a : answers)
    for (const auto& b : answers) {
      double s = 0;
      for (int q = 0; q < 5; ++q) s -= (a[q] - b[q]) * (a[q] - b[q]);
      similarity.push_back(s);
    }
  EXPECT_THAT(std::vector<double>(similarity.begin(), similarity.begin() + 5),
              ElementsAre(0, -7, -6, -12, -17));
  const double preference = *std::min_element(similarity.begin(), similarity.end());
  EXPECT_EQ(preference, -22);
  EXPECT_THAT(affinity_propagation(similarity, preference).label, ElementsAre(0u, 0u, 0u, 1u, 1u));
}

TEST(AffinityPropagation, OnePointAndEqualPoints) {
  EXPECT_THAT(affinity_propagation(std::vector<double>{0}, -1).exemplars, ElementsAre(0u));
  const auto equal = affinity_propagation(std::vector<double>(16, 0.0), -1);
  EXPECT_THAT(equal.label, Each(testing::Lt(equal.exemplars.size())));
}

TEST(Spline, PassesThroughItsSamplesAndLines) {
  const Spline line({1, 3, 5, 7});
  for (const double x : {0.0, 0.5, 1.25, 3.0}) EXPECT_NEAR(line(x), 1 + 2 * x, 1e-12);
  const Spline curve({0, 1, 0, -1, 0});
  EXPECT_NEAR(curve(1), 1, 1e-12);
  EXPECT_NEAR(curve(2), 0, 1e-12);
  EXPECT_GT(curve(0.5), 0.6);  // above the chord: it is round
  EXPECT_EQ(curve(-3), 0);
  EXPECT_EQ(curve(99), 0);
  EXPECT_EQ(Spline({4})(0.7), 4);
  EXPECT_NEAR(Spline({4, 6})(0.5), 5, 1e-12);
}

}  // namespace affinity_test
}  // namespace animeme::dam
