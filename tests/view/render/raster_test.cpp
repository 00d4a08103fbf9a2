// The renderer: exact edges, depth, the same pixels with any number of threads.
#include "tools/view/render/raster.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/view/render/scene.h"

namespace animeme::test {
namespace raster_test {

using head::Triangle;
using head::Vec3;
using render::Image;

// Triangles with one colour each, facing the camera.
struct Flat {
  std::vector<Vec3> positions, normals, colours;
  std::vector<float> occlusion;
  std::vector<Triangle> triangles;

  void add(Vec3 a, Vec3 b, Vec3 c, Vec3 colour) {
    const auto base = std::uint32_t(positions.size());
    for (const Vec3& p : {a, b, c}) {
      positions.push_back(p);
      normals.push_back({0, 0, 1});
      colours.push_back(colour);
      occlusion.push_back(1);
    }
    triangles.push_back({base, base + 1, base + 2});
  }
  render::Scene scene() const {
    return {{{positions, normals, colours, occlusion, triangles, head::SurfaceKind::cloth, {}}}};
  }
};

const std::uint8_t* pixel(const Image& image, int x, int y) {
  return &image.rgba[std::size_t(y * image.width + x) * 4];
}

const render::RenderOptions kBlack{
    .width = 101, .height = 67, .threads = 1, .background_top = 0, .background_bottom = 0};

TEST(Raster, EmptySceneIsTheBackground) {
  const Image image = render::render(
      {}, {}, {.width = 5, .height = 3, .background_top = 0x102030, .background_bottom = 0x102030});
  ASSERT_EQ(image.rgba.size(), 60u);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) {
      EXPECT_EQ(pixel(image, x, y)[0], 0x10);
      EXPECT_EQ(pixel(image, x, y)[1], 0x20);
      EXPECT_EQ(pixel(image, x, y)[2], 0x30);
      EXPECT_EQ(pixel(image, x, y)[3], 255);
    }
  }
}

// `above` over a plain colour.
int over(const std::uint8_t* above, int c, int colour) {
  return (above[c] * above[3] + colour * (255 - above[3]) + 127) / 255;
}

// Laid over any colour, a picture without a background is the picture before that colour.
TEST(Raster, WithoutBackgroundPixelsHaveAlpha) {
  Flat star;
  for (int i = 0; i < 9; ++i) {
    const float a = 0.7f * float(i);
    star.add({0.1f, 0.2f, 0}, Vec3{std::cos(a), std::sin(a), 0} * 14.0f,
             Vec3{std::cos(a + 0.3f), std::sin(a + 0.3f), 0} * 14.0f,
             {float(i % 3) / 2, 0.5f, float(i % 2)});
  }
  render::RenderOptions none = kBlack;
  none.transparent = true;
  const Image clear = render::render(star.scene(), {}, none);
  std::size_t edges = 0, empty = 0, full = 0;
  for (const std::uint32_t colour : {0x000000u, 0xFFFFFFu, 0x40C010u}) {
    render::RenderOptions plain = kBlack;
    plain.background_top = plain.background_bottom = colour;
    const Image image = render::render(star.scene(), {}, plain);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* above = pixel(clear, x, y);
        edges += above[3] > 0 && above[3] < 255;
        empty += above[3] == 0;
        full += above[3] == 255;
        for (int c = 0; c < 3; ++c) {
          const int below = int(colour >> (16 - 8 * c) & 255);
          ASSERT_NEAR(over(above, c, below), pixel(image, x, y)[c], 2) << x << " " << y;
        }
        ASSERT_EQ(pixel(image, x, y)[3], 255);
      }
    }
  }
  EXPECT_GT(edges, 100u);
  EXPECT_GT(empty, 1000u);
  EXPECT_GT(full, 1000u);
}

TEST(Raster, APictureIsBehind) {
  auto behind = std::make_shared<Image>(Image{101, 67, {}});
  for (int i = 0; i < 101 * 67; ++i) {
    behind->rgba.insert(behind->rgba.end(),
                        {std::uint8_t(i % 251), std::uint8_t(i % 83), std::uint8_t(i / 101), 7});
  }
  render::RenderOptions options = kBlack;
  options.background = behind;
  const Image image = render::render({}, {}, options);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    ASSERT_EQ(image.rgba[i], i % 4 == 3 ? 255 : behind->rgba[i]) << i;
  // Of another size it is not used.
  options.width = 50;
  EXPECT_EQ(pixel(render::render({}, {}, options), 3, 3)[0], 0);
}

// A fan of triangles about an odd point fills its square without holes or double cover.
TEST(Raster, NeighboursLeaveNoGaps) {
  Flat fan;
  constexpr int kSpokes = 37;
  for (int i = 0; i < kSpokes; ++i) {
    const float a = 6.2831853f * float(i) / kSpokes;
    const float b = 6.2831853f * float(i + 1) / kSpokes;
    fan.add({0.123f, 0.456f, 0}, Vec3{std::cos(a), std::sin(a), 0} * 60.0f,
            Vec3{std::cos(b), std::sin(b), 0} * 60.0f, {1, 1, 1});
  }
  const Image image = render::render(fan.scene(), {}, kBlack);
  const int reference = pixel(image, 50, 33)[0];
  EXPECT_GT(reference, 100);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      EXPECT_NEAR(pixel(image, x, y)[0], reference, 2) << x << " " << y;
    }
  }
}

TEST(Raster, NearerWinsWhateverTheOrder) {
  const Vec3 a{-40, -40, 0};
  const Vec3 b{40, -40, 0};
  const Vec3 c{0, 40, 0};
  const Vec3 nearer{0, 0, 5};
  Flat one;
  one.add(a, b, c, {1, 0, 0});
  one.add(a + nearer, b + nearer, c + nearer, {0, 1, 0});
  Flat two;
  two.add(a + nearer, b + nearer, c + nearer, {0, 1, 0});
  two.add(a, b, c, {1, 0, 0});
  const Image first = render::render(one.scene(), {}, kBlack);
  EXPECT_EQ(first, render::render(two.scene(), {}, kBlack));
  EXPECT_GT(pixel(first, 50, 33)[1], 100);
  EXPECT_LT(pixel(first, 50, 33)[0], 80);
}

TEST(Raster, BacksAreNotDrawn) {
  Flat back;
  back.add({-40, -40, 0}, {0, 40, 0}, {40, -40, 0}, {1, 1, 1});
  const Image image = render::render(back.scene(), {}, kBlack);
  EXPECT_EQ(image, render::render({}, {}, kBlack));
}

TEST(Raster, WildInputDrawsNothing) {
  Flat bad;
  bad.add({-40, -40, 0}, {40, -40, 0}, {0, 40, 0}, {1, 1, 1});
  bad.triangles[0][1] = 99;                                        // no such vertex
  bad.add({-1, -1, 100.5f}, {1, -1, 200}, {0, 1, 50}, {1, 1, 1});  // beside and behind the camera
  EXPECT_EQ(render::render(bad.scene(), {}, kBlack), render::render({}, {}, kBlack));
}

TEST(Raster, EdgesAreSmooth) {
  Flat slope;
  slope.add({-60, -60, 0}, {60, -60, 0}, {60, 0, 0}, {1, 1, 1});
  const Image image = render::render(slope.scene(), {}, kBlack);
  bool between = false;
  for (int x = 0; x < image.width; ++x) {
    for (int y = 0; y < image.height; ++y) {
      const int v = pixel(image, x, y)[0];
      between |= v > 20 && v < 100;
    }
  }
  EXPECT_TRUE(between);
}

TEST(Raster, ThreadsDoNotChangeAPixel) {
  const auto head = head::make_head({.density = 0.5});
  ASSERT_TRUE(head);
  const head::Rig rig = head::make_rig(*head);
  fap::Frame frame;
  frame.mask.set(1);
  frame.viseme = {10, 0, 63, false};
  frame.set(49, 20000);
  const head::Pose pose = head::pose(rig, frame);
  const render::Scene scene = render::scene_of(*head, rig, pose);
  const render::Camera camera = render::look_at(*head, 20);
  const Image one = render::render(scene, camera, {.width = 200, .height = 150, .threads = 1});
  for (const int threads : {2, 3, 4, 7}) {
    EXPECT_EQ(render::render(scene, camera, {.width = 200, .height = 150, .threads = threads}), one)
        << threads;
  }
  render::Renderer renderer({.width = 200, .height = 150, .threads = 2});
  EXPECT_EQ(renderer.render(scene, camera), one);
  EXPECT_EQ(renderer.render(scene, camera), one);  // nothing is left of the last picture
}

TEST(Views, HaveNames) {
  EXPECT_EQ(render::view_degrees("front"), 0);
  EXPECT_EQ(render::view_degrees("three-quarter"), 35);
  EXPECT_EQ(render::view_degrees("side"), 90);
  EXPECT_EQ(render::view_degrees("-30.5"), -30.5);
  EXPECT_FALSE(render::view_degrees("behind"));
  EXPECT_FALSE(render::view_degrees("30x"));
  EXPECT_FALSE(render::view_degrees(""));
}

}  // namespace raster_test
}  // namespace animeme::test
