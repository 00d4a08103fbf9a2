// glTF files written number by number, and what is read of them.
#include "tools/view/gltf/read_head.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/program.h"
#include "tests/view/gltf/square.h"
#include "tools/view/gltf/detail/extensions.h"

namespace animeme::gltf {
namespace read_head_test {

using head::Vec3;
using nlohmann::json;
using test::GltfWriter;
using ::testing::HasSubstr;

TEST(ReadHead, NodesPlaceMeshes) {
  Square square;
  const int mesh = square.file.add("meshes", {{"primitives", {square.primitive}}});
  // Turned by 90 degrees about Z, twice as large, moved; its child once more.
  square.file.add("nodes", {{"translation", {10, 0, 0}},
                            {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}},
                            {"scale", {2, 2, 2}},
                            {"children", {1}}});
  square.file.add("nodes", {{"mesh", mesh}, {"name", "child"}, {"translation", {1, 0, 0}}});
  square.file.add("scenes", {{"nodes", {0}}});
  const head::Source source = read(square.file.glb());
  ASSERT_EQ(source.pieces.size(), 1u);
  EXPECT_EQ(source.pieces[0].name, "child");
  ASSERT_EQ(source.pieces[0].mesh.positions.size(), 4u);
  expect_near(source.pieces[0].mesh.positions[0], {10, 2, 0});
  expect_near(source.pieces[0].mesh.positions[1], {10, 4, 0});
  expect_near(source.pieces[0].mesh.positions[2], {8, 4, 0});
}

TEST(ReadHead, WhatIsInNoSceneIsNotShown) {
  Square square;
  const int mesh = square.file.add("meshes", {{"primitives", {square.primitive}}});
  square.file.add("nodes", {{"mesh", mesh}, {"name", "hidden"}});
  square.file.add("nodes", {{"mesh", mesh}, {"name", "shown"}});
  square.file.add("scenes", {{"nodes", {1}}});
  const head::Source source = read(square.file.glb());
  ASSERT_EQ(source.pieces.size(), 1u);
  EXPECT_EQ(source.pieces[0].name, "shown");
}

TEST(ReadHead, OfLevelsOfDetailTheFinestIsShown) {
  Square square;
  const int mesh = square.file.add("meshes", {{"primitives", {square.primitive}}});
  for (const char* name : {"head_LOD1", "head_lod0_mesh", "teeth"}) {
    square.file.add("nodes", {{"mesh", mesh}, {"name", name}});
  }
  const head::Source source = read(square.file.glb());
  ASSERT_EQ(source.pieces.size(), 2u);
  EXPECT_EQ(source.pieces[0].name, "head_lod0_mesh");
}

TEST(ReadHead, AMirroredMeshKeepsItsFront) {
  Square square;
  const head::Source source = read(square.glb({{"scale", {-1, 1, 1}}}));
  const head::Mesh& mesh = source.pieces.at(0).mesh;
  for (const head::Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[1]] - mesh.positions[t[0]];
    const Vec3 b = mesh.positions[t[2]] - mesh.positions[t[0]];
    EXPECT_GT(head::cross(a, b).z, 0);
  }
}

TEST(ReadHead, QuantisedPlacesAndSmallIndices) {
  Square square;
  auto& attributes = square.primitive["attributes"];
  attributes["POSITION"] = square.file.accessor(
      std::vector<std::int16_t>{-32767, 0, 0, 32767, 0, 0, 0, 32767, -32768}, "VEC3", true);
  square.primitive["indices"] = square.file.accessor(std::vector<std::uint8_t>{0, 1, 2}, "SCALAR");
  square.file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  // A stride of 8, as quantised meshes have it, on morph targets of bytes.
  const int view = square.file.view(std::vector<std::int8_t>{0, 0, 0, 0, 0, 127, 0, 0, 0, 0, 0, 0});
  square.file.root["bufferViews"][std::size_t(view)]["byteStride"] = 4;
  const int moves = square.file.add("accessors", {{"bufferView", view},
                                                  {"componentType", 5120},
                                                  {"count", 3},
                                                  {"normalized", true},
                                                  {"type", "VEC3"}});
  square.primitive["targets"] = {{{"POSITION", moves}}};
  square.primitive["extras"] = {{"targetNames", {"jawOpen"}}};
  const head::Source source = read(square.glb({{"scale", {3, 3, 3}}}));
  const auto& places = source.pieces.at(0).mesh.positions;
  ASSERT_EQ(places.size(), 3u);
  expect_near(places[0], {-3, 0, 0});
  expect_near(places[2], {0, 3, -3});
  ASSERT_EQ(source.targets.size(), 1u);
  ASSERT_EQ(source.targets[0].vertices, std::vector<std::uint32_t>{1});
  expect_near(source.targets[0].deltas[0] * head::kFullShape, {0, 3, 0});
}

TEST(ReadHead, SparsePlacesAndTargets) {
  Square square;
  auto& accessor = square.file.root["accessors"][0];
  const int indices = square.file.view(std::vector<std::uint16_t>{2});
  const int values = square.file.view(std::vector<float>{5, 6, 7});
  accessor["sparse"] = {{"count", 1},
                        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                        {"values", {{"bufferView", values}}}};
  const int moves = square.file.sparse(4, std::vector<std::uint32_t>{3, 1},
                                       std::vector<float>{0, -1, 0, 0, -2, 0}, "VEC3");
  square.primitive["targets"] = {{{"POSITION", moves}}};
  square.file.add("meshes",
                  {{"primitives", {square.primitive}}, {"extras", {{"targetNames", {"jawOpen"}}}}});
  square.file.add("nodes", {{"mesh", 0}});
  const head::Source source = read(square.file.glb());
  expect_near(source.pieces.at(0).mesh.positions[2], {5, 6, 7});
  ASSERT_EQ(source.targets.size(), 1u);
  EXPECT_EQ(source.targets[0].control, head::kFirstShape);
  ASSERT_EQ(source.targets[0].vertices, (std::vector<std::uint32_t>{1, 3}));
  expect_near(source.targets[0].deltas[0] * head::kFullShape, {0, -2, 0});
}

TEST(ReadHead, StripsAndFans) {
  for (const auto& [mode, wanted] :
       {std::pair(5, std::vector<head::Triangle>{{0, 1, 2}, {1, 3, 2}}),
        std::pair(6, std::vector<head::Triangle>{{0, 1, 2}, {0, 2, 3}})}) {
    Square square;
    square.primitive["mode"] = mode;
    square.primitive.erase("indices");
    EXPECT_EQ(read(square.glb()).pieces.at(0).mesh.triangles, wanted);
  }
  Square lines;
  lines.primitive["mode"] = 1;
  EXPECT_EQ(error_of(lines.glb()).code, Code::not_found);
}

TEST(ReadHead, SeamsAreWeldedAndLipsAreNot) {
  GltfWriter file;
  // Vertex 1 and 4 are one but for their texture; 2 and 5 move apart.
  json primitive;
  primitive["attributes"]["POSITION"] = file.accessor(
      std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  primitive["indices"] = file.accessor(std::vector<std::uint32_t>{0, 1, 2, 4, 3, 5}, "SCALAR");
  primitive["targets"] = {{{"POSITION", file.sparse(6, std::vector<std::uint8_t>{5},
                                                    std::vector<float>{0, -1, 0}, "VEC3")}}};
  file.add("meshes", {{"primitives", nlohmann::json::array({primitive})},
                      {"extras", {{"targetNames", {"jawOpen"}}}}});
  file.add("nodes", {{"mesh", 0}});
  const head::Source source = read(file.glb());
  const head::Mesh& mesh = source.pieces.at(0).mesh;
  EXPECT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.triangles[0][1], mesh.triangles[1][0]);
  EXPECT_NE(mesh.triangles[0][2], mesh.triangles[1][2]);
  EXPECT_EQ(source.targets.at(0).vertices, std::vector<std::uint32_t>{mesh.triangles[1][2]});
}

TEST(ReadHead, VerticesAreFoundByTheirNumbersInTheFile) {
  GltfWriter file;
  // Vertex 2 has no triangle; 3 is vertex 1 once more, at a seam. Numbers: 0, 1, -, 2, 3, 4.
  json first, second;
  first["attributes"]["POSITION"] = file.accessor(
      std::vector<float>{0, 0, 0, 1, 0, 0, 9, 9, 9, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
  first["indices"] = file.accessor(std::vector<std::uint8_t>{0, 1, 4, 3, 5, 4}, "SCALAR");
  second["attributes"]["POSITION"] =
      file.accessor(std::vector<float>{0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3");
  file.add("meshes", {{"primitives", {first, second}}, {"name", "mesh"}});
  file.add("nodes", {{"mesh", 0}, {"name", "Anna"}});
  const auto read = read_head_and_vertices(file.glb());
  ASSERT_TRUE(read);
  ASSERT_EQ(read->meshes.size(), 1u);
  EXPECT_EQ(read->meshes[0].name, "Anna mesh");
  EXPECT_TRUE(read->meshes[0].skin);
  ASSERT_EQ(read->meshes[0].vertices.size(), 8u);
  const std::vector<head::PointRow> rows = {{"2.1", "", 2, {}, 1},
                                            {"2.2", "Anna", 4, {}, 2},
                                            {"2.3", "", {}, Vec3{0, 2, 0}, 3},
                                            {"2.4", "", 7, {}, 4}};
  const auto points = points_on(*read, rows);
  ASSERT_TRUE(points) << points.error().describe();
  const auto place = [&](std::size_t i) {
    const head::PiecePoint& point = (*points)[i];
    return read->source.pieces[point.piece].mesh.positions[point.vertex];
  };
  expect_near(place(0), {1, 0, 0});
  expect_near(place(1), {1, 1, 0});
  expect_near(place(2), {0, 2, 0});
  expect_near(place(3), {0, 2, 0});
  const auto missing = points_on(*read, {{"2.1", "", 8, {}, 5}});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::not_found);
  EXPECT_EQ(missing.error().where.line, 5);
}

TEST(ReadHead, TextFilesWithBuffersInsideAndBeside) {
  Square square;
  square.glb();
  const test::TempDir dir;
  test::spill(dir / "a.gltf", square.file.gltf(GltfWriter::data_uri(square.file.binary)));
  test::spill(dir / "b.gltf", square.file.gltf("the%20data.bin"));
  test::spill(dir / "the data.bin",
              std::string(square.file.binary.begin(), square.file.binary.end()));
  test::spill(dir / "c.gltf", square.file.gltf("../data.bin"));
  test::spill(dir / "d.gltf", square.file.gltf("missing.bin"));
  test::spill(dir / "e.gltf", square.file.gltf("https://example.org/x.bin"));
  for (const char* name : {"a.gltf", "b.gltf"}) {
    const auto source = read_head_file(dir / name);
    ASSERT_TRUE(source) << source.error().describe();
    EXPECT_EQ(source->name, std::string(name).substr(0, 1));
    EXPECT_EQ(source->pieces.at(0).mesh.positions.size(), 4u);
  }
  const auto outside = read_head_file(dir / "c.gltf");
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().code, Code::unsupported);
  const auto missing = read_head_file(dir / "d.gltf");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::not_found);
  EXPECT_EQ(missing.error().where.file, dir / "d.gltf");
  const auto web = read_head_file(dir / "e.gltf");
  ASSERT_FALSE(web);
  EXPECT_EQ(web.error().code, Code::unsupported);
  EXPECT_EQ(read_head_file(dir / "none.glb").error().code, Code::not_found);
}

TEST(ReadHeadErrors, CompressionNamesTheRemedy) {
  Square square;
  EXPECT_EQ(compressed_error("KHR_draco_mesh_compression").code, Code::unsupported);
  EXPECT_THAT(compressed_error("KHR_draco_mesh_compression").message,
              ::testing::AllOf(HasSubstr("Blender"), HasSubstr("libdraco-dev")));
  EXPECT_THAT(compressed_error("EXT_meshopt_compression").message,
              ::testing::AllOf(HasSubstr("gltfpack"), HasSubstr("libmeshoptimizer-dev")));
  square.glb();
  square.file.root["extensionsRequired"] = {"ACME_cubes"};
  EXPECT_THAT(error_of(square.file.glb()).message, HasSubstr("\"ACME_cubes\""));
}

TEST(ReadHeadErrors, WhatIsNoGltf) {
  EXPECT_EQ(error_of({}).code, Code::syntax);
  EXPECT_EQ(error_of({'g', 'l', 'T', 'F', 2, 0, 0}).code, Code::truncated);
  EXPECT_EQ(error_of({'{', '}'}).code, Code::unsupported);
  EXPECT_EQ(error_of({'{', '"'}).code, Code::syntax);
  Square square;
  std::vector<std::uint8_t> file = square.glb();
  file.resize(file.size() - 10);
  EXPECT_EQ(error_of(file).code, Code::truncated);
  file = square.file.glb();
  file[4] = 1;
  EXPECT_EQ(error_of(file).code, Code::unsupported);
  GltfWriter empty;
  EXPECT_EQ(error_of(empty.glb()).code, Code::not_found);
}

// Each says what is wrong and nothing is read beyond its place.
TEST(ReadHeadErrors, DamagedNumbers) {
  const auto with = [](const char* pointer, json value) {
    Square square;
    square.primitive["targets"] = {{{"POSITION", 0}}};
    square.glb();
    square.file.root[json::json_pointer(pointer)] = std::move(value);
    return error_of(square.file.glb()).code;
  };
  EXPECT_EQ(with("/accessors/0/count", 5), Code::syntax);
  EXPECT_EQ(with("/accessors/0/count", -1), Code::syntax);
  EXPECT_EQ(with("/accessors/0/count", 100000000), Code::out_of_range);
  EXPECT_EQ(with("/accessors/0/type", "VEC2"), Code::syntax);
  EXPECT_EQ(with("/accessors/0/componentType", 5124), Code::syntax);
  EXPECT_EQ(with("/accessors/0/bufferView", 7), Code::syntax);
  EXPECT_EQ(with("/accessors/0/byteOffset", 1000), Code::syntax);
  EXPECT_EQ(with("/bufferViews/0/byteLength", 4000), Code::syntax);
  EXPECT_EQ(with("/bufferViews/0/byteOffset", 18446744073709551615u), Code::syntax);
  EXPECT_EQ(with("/bufferViews/0/byteStride", 0), Code::syntax);
  EXPECT_EQ(with("/meshes/0/primitives/0/indices", 0), Code::syntax);
  EXPECT_EQ(with("/meshes/0/primitives/0/indices", 9), Code::syntax);
  EXPECT_EQ(with("/meshes/0/primitives/0/targets/0/POSITION", 1), Code::syntax);
  EXPECT_EQ(with("/nodes/0/mesh", 4), Code::syntax);
  EXPECT_EQ(with("/nodes/0/skin", 0), Code::syntax);
  EXPECT_EQ(with("/nodes/0/children", {0}), Code::syntax);
  EXPECT_EQ(with("/nodes/0/children", {1}), Code::syntax);
}

}  // namespace read_head_test
}  // namespace animeme::gltf
