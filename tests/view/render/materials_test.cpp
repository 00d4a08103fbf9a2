// Materials on pictures: known texels, opacity, sides, normals, seams.
#include <gtest/gtest.h>

#include <cmath>

#include "fap/head/srgb.h"
#include "tools/view/render/raster.h"

namespace animeme::test {
namespace materials_test {

using head::AlphaMode;
using head::Corner;
using head::Material;
using head::Shading;
using head::Vec3;
using render::Image;

constexpr int kSize = 64;
constexpr std::uint32_t kBehind = 0x204060;

std::shared_ptr<const head::Picture> picture_of(int width, std::vector<std::uint8_t> rgba,
                                                head::TexelKind kind = head::TexelKind::colour) {
  const int height = int(rgba.size()) / 4 / width;
  return std::make_shared<const head::Picture>(head::Texels{width, height, std::move(rgba)}, kind);
}

std::shared_ptr<const head::Picture> plain(std::uint8_t r, std::uint8_t g, std::uint8_t b,
                                           std::uint8_t a = 255) {
  return picture_of(1, {r, g, b, a});
}

Material unlit(std::shared_ptr<const head::Picture> picture) {
  Material material;
  material.shading = Shading::unlit;
  material.base = {std::move(picture), head::Wrap::clamp, head::Wrap::clamp};
  return material;
}

// Squares before the camera, each by a material of its own; x and y are -1..1 at z = 0.
struct Wall {
  std::vector<Vec3> positions, normals, colours;
  std::vector<float> occlusion;
  std::vector<Corner> corners;
  std::vector<head::Triangle> facets;
  std::vector<std::uint16_t> material_numbers;
  std::vector<Material> materials;

  void add(Material material, float left = -1, float right = 1, float z = 0) {
    const auto first = std::uint32_t(positions.size());
    for (const auto& [x, y, u, v] : {std::array{left, -1.0f, 0.0f, 1.0f},
                                     {right, -1.0f, 1, 1},
                                     {right, 1.0f, 1, 0},
                                     {left, 1.0f, 0, 0}}) {
      corners.push_back({std::uint32_t(positions.size()), {}, {u, v}, {255, 255, 255, 255}});
      positions.push_back({x, y, z});
      normals.push_back({0, 0, 1});
      colours.push_back({1, 0, 1});
      occlusion.push_back(1);
    }
    facets.push_back({first, first + 1, first + 2});
    facets.push_back({first, first + 2, first + 3});
    material_numbers.insert(material_numbers.end(), 2, std::uint16_t(materials.size()));
    materials.push_back(std::move(material));
  }

  Image draw(Vec3 eye = {0, 0, 10}, int threads = 1, int size = kSize) const {
    render::Surface surface{positions, normals, colours, occlusion, {}, head::SurfaceKind::cloth,
                            {}};
    surface.facets = facets;
    surface.corners = corners;
    surface.facet_materials = material_numbers;
    surface.materials = materials;
    surface.normals_at_rest = normals;
    // The wall fills the picture.
    return render::render({{surface}},
                          {.eye = eye, .target = {}, .view_angle = 2 * std::atan(0.1f)},
                          {.width = size,
                           .height = size,
                           .threads = threads,
                           .background_top = kBehind,
                           .background_bottom = kBehind});
  }
};

std::array<int, 3> pixel(const Image& image, int x, int y) {
  const std::uint8_t* p = &image.rgba[std::size_t(y * image.width + x) * 4];
  return {p[0], p[1], p[2]};
}

void expect_pixel(const Image& image, int x, int y, std::array<int, 3> wanted, int tolerance = 1) {
  const std::array<int, 3> is = pixel(image, x, y);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(is[k], wanted[k], tolerance) << x << " " << y;
}

TEST(Materials, UnlitTexelsAreShownAsTheyAre) {
  Wall wall;
  wall.add(unlit(picture_of(2, {10, 20, 30, 255, 200, 100, 50, 255,  //
                                1, 128, 254, 255, 0, 255, 77, 255})));
  const Image image = wall.draw();
  expect_pixel(image, 8, 8, {10, 20, 30});
  expect_pixel(image, 55, 8, {200, 100, 50});
  expect_pixel(image, 8, 55, {1, 128, 254});
  expect_pixel(image, 55, 55, {0, 255, 77});
}

TEST(Materials, FactorAndTintAreLinear) {
  Wall wall;
  Material material = unlit(plain(255, 255, 255));
  material.factor.rgb = {0.5f, 1, 0.25f};
  wall.add(std::move(material));
  for (Corner& corner : wall.corners) corner.tint = {255, 51, 255, 255};
  const auto shown = [](double light) {
    return int(std::lround(255 * head::srgb_of_linear(light)));
  };
  expect_pixel(wall.draw(), 30, 30, {shown(0.5), shown(0.2), shown(0.25)});
}

// Texels of half the width of a pixel become their mean in light: half of black and white is 188.
TEST(Materials, FarTexelsAreMeansOfLight) {
  std::vector<std::uint8_t> stripes;
  for (int i = 0; i < 128 * 128; ++i)
    stripes.insert(stripes.end(), 3, i % 2 == 0 ? 0 : 255), stripes.push_back(255);
  Wall wall;
  wall.add(unlit(picture_of(128, std::move(stripes))));
  expect_pixel(wall.draw(), 20, 40, {188, 188, 188}, 2);
}

TEST(Materials, TexturesAreInPerspective) {
  Wall wall;
  wall.add(unlit(picture_of(2, {255, 0, 0, 255, 0, 255, 0, 255})));
  for (std::size_t v = 0; v < 4; ++v) {
    // The right side is three times as far away and looks a third as wide.
    if (wall.positions[v].x > 0)
      wall.positions[v] = {wall.positions[v].x * 3, wall.positions[v].y * 3, -20};
  }
  // The border between the texels is half way on the wall, three quarters on the screen.
  const Image image = wall.draw({0, 0, 10});
  const auto middle = pixel(image, 47, 32);
  EXPECT_LT(std::abs(middle[0] - middle[1]), 60) << middle[0] << " " << middle[1];
  EXPECT_GT(pixel(image, 32, 32)[0], pixel(image, 32, 32)[1] + 100);
}

TEST(Materials, MasksDropWhatIsBelowTheCutoff) {
  Wall wall;
  Material material = unlit(picture_of(2, {255, 255, 255, 255, 255, 255, 255, 102}));
  material.alpha_mode = AlphaMode::mask;
  material.cutoff = 0.5f;
  wall.add(material);
  const Image image = wall.draw();
  expect_pixel(image, 8, 32, {255, 255, 255});
  expect_pixel(image, 55, 32, {0x20, 0x40, 0x60});
  wall.materials[0].cutoff = 0.3f;
  expect_pixel(wall.draw(), 55, 32, {255, 255, 255});
}

TEST(Materials, OpaqueOnesDoNotLookAtOpacity) {
  Wall wall;
  wall.add(unlit(plain(9, 8, 7, 0)));
  expect_pixel(wall.draw(), 30, 30, {9, 8, 7});
}

// In any order of the scene: far to near.
TEST(Materials, TransparentFacetsBlendOverWhatIsBehindThem) {
  const auto glass = [](std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    Material material = unlit(plain(r, g, b, 51));  // a fifth
    material.alpha_mode = AlphaMode::blend;
    return material;
  };
  for (const bool near_first : {true, false}) {
    Wall wall;
    wall.add(glass(200, 0, 0), -1, 1, near_first ? 1 : 0.5f);
    wall.add(glass(0, 0, 250), -1, 1, near_first ? 0.5f : 1);
    wall.add(unlit(plain(0, 100, 0)), -1, 1, 0);
    wall.add(glass(255, 255, 255), -1, 1, -1);  // hidden
    const std::array<int, 3> wanted = near_first ? std::array{40, 64, 40} : std::array{32, 64, 50};
    for (const int threads : {1, 3}) expect_pixel(wall.draw({0, 0, 10}, threads), 30, 30, wanted);
  }
}

TEST(Materials, BacksAreDrawnOfDoubleSidedOnesAlone) {
  Wall wall;
  wall.add(unlit(plain(1, 2, 3)));
  expect_pixel(wall.draw({0, 0, -10}), 30, 30, {0x20, 0x40, 0x60});
  wall.materials[0].double_sided = true;
  expect_pixel(wall.draw({0, 0, -10}), 30, 30, {1, 2, 3});
  // Lit from where the camera is, both sides look the same.
  wall.materials[0].shading = Shading::lit;
  wall.materials[0].base = {plain(128, 128, 128)};
  EXPECT_EQ(pixel(wall.draw({0, 0, 10}), 30, 30), pixel(wall.draw({0, 0, -10}), 30, 30));
}

int brightness(const Image& image, int x = 30, int y = 30) {
  const auto p = pixel(image, x, y);
  return p[0] + p[1] + p[2];
}

// The key light stands at the upper right.
TEST(Materials, NormalTexturesTurnTheLight) {
  const auto drawn = [](std::uint8_t x, std::uint8_t y, bool back = false) {
    Wall wall;
    Material material;
    material.base = {plain(150, 150, 150)};
    material.double_sided = true;
    material.normal = {picture_of(1, {x, y, 218, 255}, head::TexelKind::value)};
    wall.add(std::move(material));
    return brightness(wall.draw({0, 0, back ? -10.0f : 10.0f}));
  };
  const int flat = drawn(128, 128);
  EXPECT_GT(drawn(218, 128), flat);
  EXPECT_LT(drawn(38, 128), flat - 60);
  EXPECT_GT(drawn(128, 218), flat);
  EXPECT_LT(drawn(128, 38), flat - 60);
  // From behind, left and right change places, and the bumps are hollows.
  EXPECT_NEAR(drawn(218, 128, true), drawn(218, 128), 3);
  Wall turned;
  Material material;
  material.base = {plain(150, 150, 150)};
  material.normal = {picture_of(1, {218, 128, 218, 255}, head::TexelKind::value)};
  material.normal_scale = 0;
  turned.add(std::move(material));
  EXPECT_NEAR(brightness(turned.draw()), flat, 3);
}

TEST(Materials, OcclusionEmissionAndMetalAreSeen) {
  const auto drawn = [](auto change) {
    Wall wall;
    Material material;
    material.base = {plain(150, 120, 90)};
    change(material);
    wall.add(std::move(material));
    return pixel(wall.draw(), 30, 30);
  };
  const auto plain_one = drawn([](Material&) {});
  const auto value = [](std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    return head::Texture{picture_of(1, {r, g, b, 255}, head::TexelKind::value)};
  };
  const auto shaded = drawn([&](Material& c) { c.occlusion = value(0, 255, 255); });
  EXPECT_LT(shaded[0], plain_one[0] - 15);
  EXPECT_EQ(drawn([&](Material& c) {
              c.occlusion = value(0, 255, 255);
              c.occlusion_strength = 0;
            }),
            plain_one);
  const auto glowing = drawn([&](Material& c) {
    c.emission = {0, 0, 1};
    c.emissive = {plain(255, 255, 128)};
  });
  EXPECT_GT(glowing[2], plain_one[2] + 20);
  EXPECT_NEAR(glowing[0], plain_one[0], 12);  // less of it where the picture gets too bright
  // Metal has the colour in its highlight alone; roughness of G, metallic of B.
  const auto metal = drawn([&](Material& c) {
    c.metallic = 1;
    c.metal_rough = value(0, 255, 255);
  });
  EXPECT_NE(metal, plain_one);
  EXPECT_EQ(drawn([&](Material& c) {
              c.metallic = 1;
              c.metal_rough = value(255, 255, 0);
            }),
            plain_one);
}

// A white surface that looks at the camera shows about its own colours.
TEST(Materials, LitColoursAreNearThoseOfTheTexture) {
  Wall wall;
  Material material;
  material.base = {plain(180, 140, 120)};
  wall.add(std::move(material));
  const auto is = pixel(wall.draw(), 30, 30);
  EXPECT_NEAR(is[0], 180, 16);
  EXPECT_NEAR(is[1], 140, 16);
  EXPECT_NEAR(is[2], 120, 16);
}

TEST(Materials, ToonHasTwoTones) {
  const auto drawn = [](Vec3 normal) {
    Wall wall;
    Material material = unlit(plain(250, 200, 150));
    material.shading = Shading::toon;
    material.shade = head::linear_of_srgb(Vec3{100 / 255.0f, 50 / 255.0f, 25 / 255.0f});
    material.toony = 0.95f;
    wall.add(std::move(material));
    for (Vec3& n : wall.normals) n = head::normalised(normal);
    return pixel(wall.draw(), 30, 30);
  };
  EXPECT_EQ(drawn({0.5f, 0.5f, 0.7f}), (std::array{250, 200, 150}));
  EXPECT_EQ(drawn({-0.7f, -0.7f, 0.2f}), (std::array{100, 50, 25}));
}

// Two corners of one vertex: each side of a seam has its own texels right up to it.
TEST(Materials, SeamsAreNotSmeared) {
  Wall wall;
  std::vector<std::uint8_t> texels;
  for (int i = 0; i < 64; ++i) {
    const bool left = i % 8 < 4;
    texels.insert(texels.end(),
                  {std::uint8_t(left ? 255 : 0), 0, std::uint8_t(left ? 0 : 255), 255});
  }
  wall.materials.push_back(unlit(picture_of(8, std::move(texels))));
  for (const float x : {-1.0f, 0.0f, 1.0f}) {
    for (const float y : {-1.0f, 1.0f}) {
      wall.positions.push_back({x, y, 0});
      wall.normals.push_back({0, 0, 1});
      wall.colours.push_back({1, 1, 1});
      wall.occlusion.push_back(1);
    }
  }
  // The left half of the wall is 0.1..0.3 of the picture, the right one 0.9..0.7.
  for (const auto& [vertex, u] : {std::pair(0u, 0.1f),
                                  {1u, 0.1f},
                                  {2u, 0.3f},
                                  {3u, 0.3f},
                                  {2u, 0.9f},
                                  {3u, 0.9f},
                                  {4u, 0.7f},
                                  {5u, 0.7f}}) {
    wall.corners.push_back({vertex, {}, {u, 0.5f}, {255, 255, 255, 255}});
  }
  wall.facets = {{0, 2, 3}, {0, 3, 1}, {4, 6, 7}, {4, 7, 5}};
  wall.material_numbers.assign(4, 0);
  const Image image = wall.draw();
  for (const int y : {5, 31, 32, 60}) {
    for (int x = 0; x < 32; ++x) expect_pixel(image, x, y, {255, 0, 0});
    for (int x = 32; x < kSize; ++x) expect_pixel(image, x, y, {0, 0, 255});
  }
}

TEST(Materials, ThreadsChangeNothing) {
  Wall wall;
  Material material;
  material.base = {
      picture_of(2, {10, 200, 30, 255, 200, 100, 50, 200, 1, 128, 254, 90, 0, 255, 77, 10})};
  material.alpha_mode = AlphaMode::blend;
  wall.add(material, -1, 0.5f, 0.2f);
  wall.add(material, -0.5f, 1, 0);
  EXPECT_EQ(wall.draw({1, 2, 9}, 1, 200), wall.draw({1, 2, 9}, 3, 200));
}

TEST(Materials, WhatDoesNotExistIsNotDrawn) {
  Wall wall;
  wall.add(unlit(plain(1, 2, 3)));
  wall.corners[0].vertex = 1000;
  wall.material_numbers[1] = 7;
  expect_pixel(wall.draw(), 30, 30, {0x20, 0x40, 0x60});
}

}  // namespace materials_test
}  // namespace animeme::test
