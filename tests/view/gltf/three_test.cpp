// Materials as three.js draws them: the same file, camera and lights in Chromium.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tests/view/gltf/square.h"
#include "tools/view/render/png.h"
#include "tools/view/render/raster.h"

namespace animeme::gltf {
namespace three_test {

using head::Vec3;
using nlohmann::json;
namespace fs = std::filesystem;

constexpr int kSize = 256;
constexpr std::uint32_t kBackground = 0x406080;

// Texels by a function of their place.
template <class Texel>
json image_of(int size, Texel texel) {
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      for (const int part : texel(x, y)) rgba.push_back(std::uint8_t(part));
    }
  }
  return {{"uri", test::GltfWriter::data_uri(test::png_of(rgba, size), "image/png")}};
}

using Four = std::array<int, 4>;

// A ball with everything that glTF has for light, a leaf with holes before it, a pane of glass, and
// a leaf that shows its back.
std::vector<std::uint8_t> scene_file() {
  test::GltfWriter file;
  file.add("images", image_of(64, [](int x, int y) {
             return Four{x / 8 % 2 == 0 ? 200 : 120, y / 8 % 2 == 0 ? 150 : 90, 70, 255};
           }));
  file.add("images", image_of(32, [](int x, int y) {
             return Four{128 + int(50 * std::sin(x)), 128 + int(40 * std::cos(y)), 230, 255};
           }));
  file.add("images", image_of(16, [](int x, int y) {
             return Four{100 + 10 * y, 40 + 12 * x, 0, 255};
           }));
  file.add("images", image_of(32, [](int x, int y) {
             const bool hole = (x - 16) * (x - 16) + (y - 16) * (y - 16) < 60;
             return Four{220, 60, 60, hole ? 0 : 255};
           }));
  for (int i = 0; i < 4; ++i) file.add("textures", {{"source", i}});
  // three.js has one colour space for a texture, however it is used.
  file.add("textures", {{"source", 0}});
  file.root["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}}},
         {"metallicRoughnessTexture", {{"index", 2}}},
         {"metallicFactor", 0}}},
       {"normalTexture", {{"index", 1}, {"scale", 0.6}}},
       {"occlusionTexture", {{"index", 2}, {"strength", 0.7}}},
       {"emissiveTexture", {{"index", 4}}},
       {"emissiveFactor", {0, 0.15, 0}}},
      {{"alphaMode", "MASK"},
       {"doubleSided", true},
       {"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 3}}}, {"metallicFactor", 0}, {"roughnessFactor", 0.4}}}},
      {{"alphaMode", "BLEND"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.3, 0.9, 0.4}}, {"metallicFactor", 0}}}},
      {{"doubleSided", true},
       {"normalTexture", {{"index", 1}}},
       {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}}};
  std::vector<float> places, normals, uvs;
  std::vector<std::uint16_t> indices;
  constexpr int kAround = 48, kDown = 24;
  for (int row = 0; row <= kDown; ++row) {
    for (int column = 0; column <= kAround; ++column) {
      const float u = float(column) / kAround, v = float(row) / kDown;
      const float a = 2 * std::numbers::pi_v<float> * u, b = std::numbers::pi_v<float> * v;
      const Vec3 n{std::sin(a) * std::sin(b), std::cos(b), -std::cos(a) * std::sin(b)};
      places.insert(places.end(), {2 * n.x, 2 * n.y, 2 * n.z});
      normals.insert(normals.end(), {n.x, n.y, n.z});
      uvs.insert(uvs.end(), {3 * (1 - u), 2 * v});
      if (row == kDown || column == kAround) continue;
      const int at = row * (kAround + 1) + column;
      for (const int k : {at, at + 1, at + kAround + 2, at, at + kAround + 2, at + kAround + 1}) {
        indices.push_back(std::uint16_t(k));
      }
    }
  }
  const auto add = [&](int material, bool leaf, json node) {
    json primitive{{"material", material}};
    if (leaf) {
      primitive["attributes"] = {
          {"POSITION",
           file.accessor(std::vector<float>{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3")},
          {"NORMAL", file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")},
          {"TEXCOORD_0", file.accessor(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2")}};
      primitive["indices"] = file.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR");
    } else {
      primitive["attributes"] = {{"POSITION", file.accessor(places, "VEC3")},
                                 {"NORMAL", file.accessor(normals, "VEC3")},
                                 {"TEXCOORD_0", file.accessor(uvs, "VEC2")}};
      primitive["indices"] = file.accessor(indices, "SCALAR");
    }
    node["mesh"] = file.add("meshes", {{"primitives", {primitive}}});
    node["name"] = "leaf " + std::to_string(file.root["nodes"].size());
    file.add("nodes", std::move(node));
  };
  add(0, false, {});
  add(1, true, {{"translation", {-1.5, 1, 2.2}}, {"rotation", {0, 0.3, 0, 0.954}}});
  add(2, true, {{"translation", {1.2, 0.8, 2.5}}});
  // Turned about: its back is seen.
  add(3, true, {{"translation", {0.3, -1.6, 2.4}}, {"rotation", {0.2, 0.97, 0, 0.138}}});
  file.add("scenes", {{"nodes", {0, 1, 2, 3}}});
  return file.glb();
}

render::Image drawn(const head::Source& source, const render::Camera& camera) {
  std::vector<std::vector<Vec3>> normals;
  std::vector<std::vector<float>> skies;
  render::Scene scene;
  normals.reserve(source.pieces.size());
  skies.reserve(source.pieces.size());
  for (const head::Piece& piece : source.pieces) {
    const head::Mesh& mesh = piece.mesh;
    // Those of the file: as the mesh is at rest, they stay.
    normals.emplace_back(mesh.positions.size(), Vec3{0, 0, 1});
    skies.emplace_back(mesh.positions.size(), 1.0f);
    render::Surface surface{mesh.positions, normals.back(), mesh.colours, skies.back(), {}};
    surface.facets = mesh.facets;
    surface.corners = mesh.corners;
    surface.facet_materials = mesh.materials;
    surface.materials = source.materials;
    surface.normals_at_rest = normals.back();
    scene.surfaces.push_back(surface);
  }
  return render::render(scene, camera,
                        {.width = kSize,
                         .height = kSize,
                         .background_top = kBackground,
                         .background_bottom = kBackground});
}

TEST(ThreeJs, DrawsTheSame) {
  const fs::path root = fs::path(test::kSourceFolder) / "tests";
  if (!test::has_program("node")) GTEST_SKIP() << "node is not installed (Debian package nodejs)";
  if (!test::has_program("chromium")) GTEST_SKIP() << "chromium is not installed";
  if (!fs::exists(root / "readers/js/node_modules/three")) {
    GTEST_SKIP() << "npm three is not installed: tools/setup.sh tests";
  }
  const test::TempDir dir;
  const std::vector<std::uint8_t> file = scene_file();
  test::spill(dir / "scene.glb", std::string(file.begin(), file.end()));
  const render::Camera camera{.eye = {2, 1, 12}, .target = {0, 0, 0}, .view_angle = 0.5f};
  const json wanted{{"eye", {camera.eye.x, camera.eye.y, camera.eye.z}},
                    {"target", {0, 0, 0}},
                    {"angle", camera.view_angle},
                    {"size", kSize},
                    {"background", kBackground}};
  test::spill(dir / "camera.json", wanted.dump());
  int status = 0;
  const json report = json::parse(
      test::run("node " + test::quoted((root / "view/gltf/scripts/three.js").string()) + " " +
                    test::quoted(dir / "scene.glb") + " " + test::quoted(dir / "camera.json") +
                    " " + test::quoted(dir / "three.rgb"),
                &status),
      nullptr, false);
  ASSERT_EQ(status, 0);
  std::ifstream in(dir / "three.rgb", std::ios::binary);
  const std::vector<char> theirs((std::istreambuf_iterator<char>(in)), {});
  ASSERT_EQ(theirs.size(), std::size_t(kSize * kSize * 3));
  const head::Source source = read(file, {.vertices = 0});
  ASSERT_EQ(source.pieces.size(), 4u);
  const render::Image ours = drawn(source, camera);
  double sum = 0;
  int far = 0;
  for (std::size_t i = 0; i < kSize * kSize; ++i) {
    int most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int apart = std::abs(int(std::uint8_t(theirs[i * 3 + k])) - int(ours.rgba[i * 4 + k]));
      sum += apart;
      most = std::max(most, apart);
    }
    far += most > 16 ? 1 : 0;
  }
  RecordProperty("mean", std::to_string(sum / (kSize * kSize * 3)));
  RecordProperty("far", std::to_string(double(far) / (kSize * kSize)));
  EXPECT_LT(sum / (kSize * kSize * 3), 0.8);
  EXPECT_LT(double(far) / (kSize * kSize), 0.01);  // at contours
  if (!HasFailure()) return;
  const auto png = render::png_of(ours);  // to look at
  test::spill(fs::temp_directory_path() / "ours.png", std::string(png->begin(), png->end()));
  fs::copy_file(dir / "three.png", fs::temp_directory_path() / "three.png",
                fs::copy_options::overwrite_existing);
}

}  // namespace three_test
}  // namespace animeme::gltf
