// Fits of a head's place.
#include "fap/detail/similarity.h"

#include <gtest/gtest.h>

#include "tests/fap/make.h"

namespace animeme::fap {
namespace similarity_test {

using made::Random;

TEST(Similarity, WhatIsOpenIsNotAnswered) {
  using internal::fit_similarity;
  const std::vector<double> weights(4, 1.0);
  const std::vector<Point> line = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  const std::vector<Point> place(4, Point{1, 2, 3});
  EXPECT_FALSE(fit_similarity(line, line, weights, true));
  EXPECT_TRUE(fit_similarity(line, line, weights, false));
  EXPECT_FALSE(fit_similarity(place, place, weights, true));
  EXPECT_FALSE(fit_similarity(place, place, weights, false));
  EXPECT_FALSE(fit_similarity({}, {}, {}, true));
}

TEST(Similarity, AnglesComeBack) {
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    const auto angle = [&](int limit) { return double(random.in(-limit, limit)) * 1e-3; };
    const internal::HeadAngles given{angle(1500), angle(3000), angle(3000)};
    const internal::HeadAngles found = internal::angles_of(internal::rotation_of(given));
    EXPECT_NEAR(found.pitch, given.pitch, 1e-9);
    EXPECT_NEAR(found.yaw, given.yaw, 1e-9);
    EXPECT_NEAR(found.roll, given.roll, 1e-9);
  }
}

}  // namespace similarity_test
}  // namespace animeme::fap
