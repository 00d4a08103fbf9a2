// Colours of vertices, materials and textures.
#include <cmath>

#include "tests/view/gltf/square.h"

namespace animeme::gltf {
namespace head_colours_test {

using head::Vec3;
using test::GltfWriter;
using ::testing::HasSubstr;

TEST(ReadHead, ColoursAreVertexTimesFactor) {
  Square square;
  square.primitive["attributes"]["COLOR_0"] = square.file.accessor(
      std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255},
      "VEC4", true);
  square.primitive["material"] = square.file.add(
      "materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 1, 1}}}}});
  const head::Source source = read(square.glb());
  const auto& colours = source.pieces.at(0).mesh.colours;
  ASSERT_EQ(colours.size(), 4u);
  expect_near(colours[0], {0.5f, 0, 0});
  expect_near(colours[3], {0.5f, 0.25f, 1});
}

TEST(ReadHead, WithoutColoursNoneIsGiven) {
  Square square;
  EXPECT_TRUE(read(square.glb()).pieces.at(0).mesh.colours.empty());
}

TEST(ReadHead, TexturesAreSampledAtTheVertices) {
  Square square;
  square.add_uvs({0.25f, 0.75f, 0.75f, 0.75f, 0.75f, 0.25f, 0.25f, 0.25f});
  square.add_texture();
  const head::Source source = read(square.glb(), {.vertices = 0});
  const auto& colours = source.pieces.at(0).mesh.colours;
  ASSERT_EQ(colours.size(), 4u);
  expect_near(colours[0], {1, 0, 0});
  expect_near(colours[1], {0, 1, 0});
  expect_near(colours[3], {1, 0, 0});
}

// Red to green at the middle: with new vertices the border is sharp.
TEST(ReadHead, TrianglesAreDividedWhereTheTextureChanges) {
  Square square;
  square.add_uvs();
  square.add_texture();
  const head::Source source = read(square.glb(), {.vertices = 2000});
  const head::Mesh& mesh = source.pieces.at(0).mesh;
  EXPECT_GT(mesh.positions.size(), 20u);
  EXPECT_LE(mesh.positions.size(), 2000u);
  int clear = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const float x = mesh.positions[v].x;
    if (std::abs(x - 0.5f) < 0.2f || std::abs(x - 0.5f) > 0.3f) continue;
    ++clear;
    const Vec3 wanted = x < 0.5f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    expect_near(mesh.colours[v], wanted, 0.15f);
  }
  EXPECT_GT(clear, 0);
  // No crack: each inner edge has two triangles, and the area is the same.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  float area = 0;
  for (const head::Triangle& t : mesh.triangles) {
    const Vec3 n = head::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                               mesh.positions[t[2]] - mesh.positions[t[0]]);
    EXPECT_GT(n.z, 0);
    area += n.z / 2;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      ++edges[{std::min(a, b), std::max(a, b)}];
    }
  }
  EXPECT_NEAR(area, 1, 1e-4);
  for (const auto& [edge, count] : edges) {
    const Vec3 middle = (mesh.positions[edge.first] + mesh.positions[edge.second]) * 0.5f;
    const bool border =
        middle.x < 1e-6f || middle.y < 1e-6f || middle.x > 1 - 1e-6f || middle.y > 1 - 1e-6f;
    EXPECT_EQ(count, border ? 1 : 2);
  }
}

TEST(ReadHead, TextureTransformsAndWrapping) {
  for (const char* wrapping : {"repeat", "mirror", "clamp"}) {
    Square square;
    square.add_uvs({1.25f, 0.5f, 1.25f, 0.5f, 1.25f, 0.5f, 1.25f, 0.5f});
    square.add_texture({{"index", 0}});
    const int mode = wrapping[0] == 'r' ? 10497 : wrapping[0] == 'm' ? 33648 : 33071;
    square.file.root["textures"][0]["sampler"] = square.file.add("samplers", {{"wrapS", mode}});
    // 0.25 again is red, its mirror image 0.75 green, the edge green.
    const head::Source source = read(square.glb());
    expect_near(source.pieces.at(0).mesh.colours[0], mode == 10497 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
  }
  Square square;
  square.add_uvs({0.25f, 0.5f, 0.25f, 0.5f, 0.25f, 0.5f, 0.25f, 0.5f});
  square.add_texture(
      {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}});
  expect_near(read(square.glb()).pieces.at(0).mesh.colours[0], {0, 1, 0});
}

TEST(ReadHead, TransparentTrianglesAreLeftOut) {
  Square mask;
  mask.add_uvs();
  mask.add_texture({{"index", 0}}, {{"alphaMode", "MASK"}});
  const head::Source half = read(mask.glb(), {.vertices = 2000});
  for (const Vec3& p : half.pieces.at(0).mesh.positions) EXPECT_LT(p.x, 0.7f);
  Square glass;
  glass.primitive["material"] = glass.file.add(
      "materials",
      {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.1}}}}});
  glass.file.add("meshes", {{"primitives", {glass.primitive}}});
  glass.primitive.erase("material");
  glass.file.add("nodes", {{"mesh", 0}, {"name", "wet layer"}});
  glass.file.add("meshes", {{"primitives", {glass.primitive}}});
  glass.file.add("nodes", {{"mesh", 1}, {"name", "eyes"}});
  const head::Source seen = read(glass.file.glb());
  ASSERT_EQ(seen.pieces.size(), 1u);
  EXPECT_THAT(seen.notes.at(0), HasSubstr("\"wet layer\" is transparent"));
}

TEST(ReadHead, ATextureThatCannotBeReadIsNoted) {
  Square square;
  square.add_uvs();
  square.add_texture();
  square.file.root["images"][0]["uri"] = GltfWriter::data_uri({1, 2, 3});
  const head::Source source = read(square.glb());
  EXPECT_TRUE(source.pieces.at(0).mesh.colours.empty());
  EXPECT_THAT(source.notes.at(0), HasSubstr("neither PNG nor JPEG"));
}

}  // namespace head_colours_test
}  // namespace animeme::gltf
