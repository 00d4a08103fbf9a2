// Skin on the page: pores and lines as the renderer draws them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/view/viewer/page_support.h"
#include "tools/view/render/detail/grain.h"
#include "tools/view/render/scene.h"

namespace animeme::test {
namespace page_grain_test {

TEST(PageGrain, IsThatOfTheRenderer) {
  if (!has_node()) GTEST_SKIP() << "node 18 or later is not installed (Debian package nodejs)";
  const Json report = run_json("node '" + std::string(test::kSourceFolder) +
                               "/tests/view/viewer/js/grain_report.mjs'");
  EXPECT_EQ(report["block"].get<Bytes>(), render::detail::grain_block());
}

// What a pixel is brighter than the eight around it; nothing at borders.
double above_neighbours(const std::uint8_t* pixels, int channels, int width, int x, int y) {
  double sum = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const std::uint8_t* p = pixels + ((y + j) * width + x + i) * channels;
      sum += (i == 0 && j == 0 ? 8 : -1) * double(p[1]);
    }
  }
  return sum / 8;
}

TEST(PageGrain, LooksAsTheRendererDrawsIt) {
  NEEDS_BROWSER();
  const TempDir dir;
  const TestHead& h = test_head();
  const Json report = report_of("closeup", make({{moving_clip(), 0, "clip"}}), dir);
  ASSERT_TRUE(report.contains("width"));
  EXPECT_EQ(said(report), std::vector<std::string>());
  const int width = report["width"], height = report["height"];
  const head::Pose pose = head::pose(h.rig, {});
  const render::RenderOptions options{.width = width, .height = height};
  const render::Camera camera = render::look_at(h.head, 20, 0, 9);
  render::Scene scene = render::scene_of(h.head, h.rig, pose);
  const render::Image fine = render::render(scene, camera, options);
  for (render::Surface& surface : scene.surfaces) surface.grain = {};
  const render::Image smooth = render::render(scene, camera, options);
  const Bytes page = read_bytes(dir.file("picture.rgb"));
  ASSERT_EQ(page.size(), std::size_t(width) * std::size_t(height) * 3);
  double ours = 0, theirs = 0, both = 0;
  std::size_t count = 0;
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const double s = above_neighbours(smooth.rgba.data(), 4, width, x, y);
      const double a = above_neighbours(fine.rgba.data(), 4, width, x, y);
      const double b = above_neighbours(page.data(), 3, width, x, y);
      // Skin, but no contours.
      if (a == s || std::abs(s) > 1.5 || std::abs(b) > 15) continue;
      ours += a * a, theirs += b * b, both += a * b;
      ++count;
    }
  }
  ASSERT_GT(count, std::size_t(width * height / 20));
  RecordProperty("ours", std::to_string(std::sqrt(ours / double(count))));
  RecordProperty("theirs", std::to_string(std::sqrt(theirs / double(count))));
  RecordProperty("alike", std::to_string(both / std::sqrt(ours * theirs)));
  EXPECT_GT(std::sqrt(ours / double(count)), 0.5);
  EXPECT_NEAR(std::sqrt(theirs / ours), 1, 0.35);
  EXPECT_GT(both / std::sqrt(ours * theirs), 0.6);
}

}  // namespace page_grain_test
}  // namespace animeme::test
