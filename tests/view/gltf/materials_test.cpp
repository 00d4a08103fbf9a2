// Materials of files, and pictures of them.
#include <cmath>

#include "tests/view/gltf/square.h"
#include "tools/view/render/raster.h"

namespace animeme::gltf {
namespace materials_test {

using head::Material;
using head::Shading;
using head::Vec3;
using nlohmann::json;
using test::GltfWriter;
using ::testing::Contains;
using ::testing::HasSubstr;

const Material& material_of(const head::Source& source, std::size_t facet = 0) {
  return source.materials.at(source.pieces.at(0).mesh.materials.at(facet));
}

head::Source read_square(const json& material, const json& root = {}) {
  Square square;
  square.add_uvs();
  square.add_texture({{"index", 0}}, material);
  if (!root.is_null()) square.file.root.update(root);
  return read(square.glb(), {.vertices = 0});
}

// The piece alone, from the front, a pixel a texel of its picture or more.
render::Image drawn(const head::Source& source, int size = 32) {
  const head::Mesh& mesh = source.pieces.at(0).mesh;
  const std::vector<Vec3> normals(mesh.positions.size(), Vec3{0, 0, 1});
  const std::vector<Vec3> colours(mesh.positions.size(), Vec3{1, 1, 1});
  const std::vector<float> sky(mesh.positions.size(), 1.0f);
  render::Surface surface{mesh.positions, normals, colours, sky, mesh.triangles};
  surface.facets = mesh.facets;
  surface.corners = mesh.corners;
  surface.facet_materials = mesh.materials;
  surface.materials = source.materials;
  surface.normals_at_rest = normals;
  return render::render(
      {{surface}},
      {.eye = {0.5f, 0.5f, 5}, .target = {0.5f, 0.5f, 0}, .view_angle = 2 * std::atan(0.1f)},
      {.width = size, .height = size, .background_top = 0x0000FF, .background_bottom = 0x0000FF});
}

std::array<int, 3> at(const render::Image& image, int x, int y) {
  const std::uint8_t* p = &image.rgba[std::size_t(y * image.width + x) * 4];
  return {p[0], p[1], p[2]};
}

constexpr std::array kRed = {255, 0, 0}, kGreen = {0, 255, 0}, kBlue = {0, 0, 255};

const json kUnlit = {{"KHR_materials_unlit", json::object()}};

TEST(Materials, AnUnlitTextureIsShownTexelByTexel) {
  const head::Source source = read_square({{"extensions", kUnlit}});
  EXPECT_EQ(material_of(source).shading, Shading::unlit);
  const render::Image image = drawn(source);
  EXPECT_EQ(at(image, 8, 20), kRed);
  EXPECT_EQ(at(image, 24, 20), kGreen);
}

TEST(Materials, MaskedAndTransparent) {
  const head::Source mask = read_square({{"extensions", kUnlit}, {"alphaMode", "MASK"}});
  EXPECT_EQ(at(drawn(mask), 8, 20), kRed);
  EXPECT_EQ(at(drawn(mask), 24, 20), kBlue);
  const head::Source blend =
      read_square({{"extensions", kUnlit},
                   {"alphaMode", "BLEND"},
                   {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.6}}}}});
  const auto mixed = at(drawn(blend), 8, 20);
  EXPECT_NEAR(mixed[0], 153, 1);
  EXPECT_NEAR(mixed[2], 102, 1);
  EXPECT_EQ(at(drawn(blend), 24, 20), kBlue);
  // They are drawn, and are no triangles of the head.
  const head::Mesh& mesh = blend.pieces.at(0).mesh;
  EXPECT_LT(mesh.triangles.size(), mesh.facets.size());
  EXPECT_EQ(mesh.materials.size(), mesh.facets.size());
}

// The square is cut along its diagonal with doubled vertices: one mesh, two maps of the texture.
TEST(Materials, CornersKeepSeamsThatAreWelded) {
  Square square;
  square.primitive["attributes"]["POSITION"] = square.file.accessor(
      std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  square.primitive["indices"] =
      square.file.accessor(std::vector<std::uint16_t>{0, 1, 2, 3, 4, 5}, "SCALAR");
  square.add_uvs({0.2f, 0.5f, 0.2f, 0.5f, 0.2f, 0.5f, 0.8f, 0.5f, 0.8f, 0.5f, 0.8f, 0.5f});
  square.add_texture({{"index", 0}}, {{"extensions", kUnlit}});
  const head::Source source = read(square.glb(), {.vertices = 0});
  const head::Mesh& mesh = source.pieces.at(0).mesh;
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.corners.size(), 6u);
  const render::Image image = drawn(source);
  for (int i = 2; i < 30; ++i) {
    EXPECT_EQ(at(image, i + 1, 31 - i), kRed) << i;
    EXPECT_EQ(at(image, i - 1, 31 - i), kGreen) << i;
  }
}

TEST(Materials, AllThatGltfSaysIsTaken) {
  Square square;
  square.add_uvs();
  square.primitive["attributes"]["NORMAL"] =
      square.file.accessor(std::vector<float>{0, 0, 2, 0, 0, 1, 0, 0, 1, 0, 3, 4}, "VEC3");
  square.add_texture({{"index", 0}},
                     {{"doubleSided", true},
                      {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                      {"occlusionTexture", {{"index", 0}, {"strength", 0.25}}},
                      {"emissiveFactor", {0.5, 0, 1}},
                      {"emissiveTexture", {{"index", 0}}},
                      {"pbrMetallicRoughness",
                       {{"metallicFactor", 0.75},
                        {"roughnessFactor", 0.5},
                        {"metallicRoughnessTexture", {{"index", 0}}}}},
                      {"extensions",
                       {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}},
                        {"KHR_materials_specular", {{"specularFactor", 0.3}}}}}});
  const head::Source source = read(square.glb(), {.vertices = 0});
  const Material& material = material_of(source);
  EXPECT_TRUE(material.double_sided);
  EXPECT_EQ(material.shading, Shading::lit);
  EXPECT_EQ(material.base.picture->kind(), head::TexelKind::colour);
  EXPECT_EQ(material.base.picture->type(), "image/png");
  EXPECT_EQ(material.emissive.picture, material.base.picture);
  EXPECT_EQ(material.normal.picture->kind(), head::TexelKind::value);
  EXPECT_EQ(material.metal_rough.picture, material.normal.picture);
  EXPECT_EQ(material.occlusion.picture, material.normal.picture);
  EXPECT_FLOAT_EQ(material.normal_scale, 0.5f);
  EXPECT_FLOAT_EQ(material.occlusion_strength, 0.25f);
  EXPECT_FLOAT_EQ(material.metallic, 0.75f);
  EXPECT_FLOAT_EQ(material.roughness, 0.5f);
  EXPECT_FLOAT_EQ(material.specular, 0.3f);
  expect_near(material.emission, {1, 0, 2});
  expect_near(source.pieces.at(0).mesh.corners.at(0).normal, {0, 0, 1});
  expect_near(source.pieces.at(0).mesh.corners.at(3).normal, {0, 0.6f, 0.8f});
}

TEST(Materials, ToonOfBothVersionsOfVrm) {
  const json toon = {{"shadeColorFactor", {0.1, 0.2, 0.3}},
                     {"shadingToonyFactor", 0.8},
                     {"shadingShiftFactor", -0.1},
                     {"shadeMultiplyTexture", {{"index", 0}}}};
  const head::Source one = read_square({{"extensions", {{"VRMC_materials_mtoon", toon}}}});
  EXPECT_EQ(material_of(one).shading, Shading::toon);
  expect_near(material_of(one).shade, {0.1f, 0.2f, 0.3f});
  EXPECT_FLOAT_EQ(material_of(one).toony, 0.8f);
  EXPECT_FLOAT_EQ(material_of(one).shade_shift, -0.1f);
  EXPECT_EQ(material_of(one).shade_texture.picture, material_of(one).base.picture);
  // As VRM's migration has it: toony 0.9 and shift 0 become 0.95 and -0.05; colours are sRGB.
  const json old = {
      {"shader", "VRM/MToon"},
      {"floatProperties", {{"_ShadeToony", 0.9}, {"_ShadeShift", 0}}},
      {"vectorProperties", {{"_Color", {1, 1, 1, 1}}, {"_ShadeColor", {0.5, 0.5, 0.5, 1}}}},
      {"textureProperties", {{"_MainTex", 0}, {"_ShadeTexture", 0}}}};
  const head::Source zero =
      read_square({{"extensions", kUnlit}},
                  {{"extensions", {{"VRM", {{"materialProperties", json::array({old})}}}}}});
  EXPECT_EQ(material_of(zero).shading, Shading::toon);
  EXPECT_FLOAT_EQ(material_of(zero).toony, 0.95f);
  EXPECT_FLOAT_EQ(material_of(zero).shade_shift, -0.05f);
  expect_near(material_of(zero).shade, {0.2140f, 0.2140f, 0.2140f}, 1e-3f);
}

TEST(Materials, Ktx2IsNamedAndTheFactorDrawn) {
  Square square;
  square.add_uvs();
  square.add_texture({{"index", 0}}, {{"extensions", kUnlit}, {"name", "Cheek"}});
  square.file.add("textures", {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
  square.file.root["materials"].push_back(
      {{"name", "Coded"},
       {"extensions", kUnlit},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0, 1, 0, 1}}, {"baseColorTexture", {{"index", 1}}}}}});
  json coded = square.primitive;
  coded["material"] = 1;
  square.file.add("meshes", {{"primitives", {coded}}});
  square.file.add("nodes", {{"mesh", 0}, {"name", "coded"}});
  const head::Source source = read(square.glb({{"children", {0}}}), {.vertices = 0});
  EXPECT_THAT(source.notes, Contains(::testing::AllOf(HasSubstr("\"Coded\" is KTX2"),
                                                      HasSubstr("PNG, JPEG or WebP"))));
  EXPECT_EQ(at(drawn(source), 8, 20), kGreen);
}

TEST(Materials, HeadsWithoutPicturesHaveNoMaterials) {
  Square square;
  square.primitive["material"] = square.file.add(
      "materials",
      {{"doubleSided", true}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
  const head::Source source = read(square.glb());
  EXPECT_TRUE(source.materials.empty());
  EXPECT_TRUE(source.pieces.at(0).mesh.facets.empty());
  EXPECT_TRUE(source.pieces.at(0).mesh.corners.empty());
}

TEST(Materials, TransformsMoveCorners) {
  Square square;
  square.add_uvs();
  square.add_texture(
      {{"index", 0},
       {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"scale", {0.5, 1}}}}}}},
      {{"extensions", kUnlit}});
  // The right half of the picture, which is green, on all of the square.
  const render::Image image = drawn(read(square.glb(), {.vertices = 0}));
  EXPECT_EQ(at(image, 12, 20), kGreen);
  EXPECT_EQ(at(image, 20, 20), kGreen);
}

}  // namespace materials_test
}  // namespace animeme::gltf
