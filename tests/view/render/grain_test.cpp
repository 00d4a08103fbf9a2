// The relief of skin: as strong as it can be seen, and no darker than smooth skin.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tools/view/render/raster.h"

namespace animeme::test {
namespace render_grain_test {

using head::Vec3;

// A square of skin of 8 cm, seen from so far away: mean and deviation of its green.
std::array<double, 2> skin_from(float distance, float relief) {
  const std::array<Vec3, 4> places = {{{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}}};
  const std::array<Vec3, 4> normals = {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}}};
  const std::array<Vec3, 4> colours = {
      {{0.5f, 0.3f, 0.2f}, {0.5f, 0.3f, 0.2f}, {0.5f, 0.3f, 0.2f}, {0.5f, 0.3f, 0.2f}}};
  const std::array<float, 4> occlusion = {1, 1, 1, 1};
  const std::array<head::Triangle, 2> triangles = {{{0, 1, 2}, {0, 2, 3}}};
  std::array<head::Grain, 4> grain;
  grain.fill({relief, 0});
  render::Surface surface{places, normals, colours, occlusion, triangles, {}, {}};
  surface.grain = grain;
  surface.positions_at_rest = places;
  const render::Image image =
      render::render({{surface}}, {.eye = {0, 0, distance}}, {.width = 200, .height = 200});
  double sum = 0, squares = 0;
  int count = 0;
  for (int y = 90; y < 110; ++y) {
    for (int x = 90; x < 110; ++x, ++count) {
      const double green = image.rgba[std::size_t(y * 200 + x) * 4 + 1];
      sum += green;
      squares += green * green;
    }
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0))};
}

TEST(RenderGrain, IsSeenFromNear) {
  const auto smooth = skin_from(15, 0);
  EXPECT_LT(smooth[1], 1.5);
  double before = 20;
  for (const float distance : {4.0f, 8.0f, 80.0f}) {
    const auto pores = skin_from(distance, 1), lines = skin_from(distance, -1);
    EXPECT_NEAR(pores[0], skin_from(distance, 0)[0], 4) << distance;
    EXPECT_NEAR(lines[0], skin_from(distance, 0)[0], 4) << distance;
    EXPECT_LE(pores[1], before * 1.2) << distance;
    before = pores[1];
    if (distance < 10) {
      EXPECT_GT(pores[1], 2.0) << distance;
      EXPECT_GT(lines[1], 2.0) << distance;
    }
  }
  EXPECT_EQ(before, skin_from(80, 0)[1]);
}

// Nearer than a texel a pixel, it has no steps.
TEST(RenderGrain, IsSmoothFromVeryNear) {
  const auto near = skin_from(2, 1);
  EXPECT_LT(near[1], skin_from(15, 1)[1] * 1.5);
}

}  // namespace render_grain_test
}  // namespace animeme::test
