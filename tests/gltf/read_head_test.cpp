// glTF files written number by number, and what is read of them.
#include "tools/gltf/read_head.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/support/gltf_writer.h"
#include "tests/support/png_writer.h"
#include "tests/support/program.h"

namespace animeme::gltf {
namespace {

using head::Vec3;
using nlohmann::json;
using test::GltfWriter;
using ::testing::HasSubstr;

head::Source read(const std::vector<std::uint8_t>& file, const ReadOptions& options = {}) {
  auto source = read_head(file, options);
  EXPECT_TRUE(source) << source.error().describe();
  return source ? std::move(*source) : head::Source{};
}

Error error_of(const std::vector<std::uint8_t>& file) {
  auto source = read_head(file);
  EXPECT_FALSE(source);
  return source ? Error{} : source.error();
}

void expect_near(Vec3 is, Vec3 wanted, float tolerance = 1e-5f) {
  EXPECT_NEAR(is.x, wanted.x, tolerance);
  EXPECT_NEAR(is.y, wanted.y, tolerance);
  EXPECT_NEAR(is.z, wanted.z, tolerance);
}

// A square of two triangles, 0..1 in x and y.
struct Square {
  GltfWriter file;
  json primitive;

  Square() {
    primitive["attributes"]["POSITION"] =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    primitive["indices"] = file.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, "SCALAR");
  }
  void add_uvs(const std::vector<float>& uvs = {0, 1, 1, 1, 1, 0, 0, 0}) {
    primitive["attributes"]["TEXCOORD_0"] = file.accessor(uvs, "VEC2");
  }
  // 4 x 4 texels, the left half red, the right half green.
  void add_texture(json info = {{"index", 0}}, json material = json::object()) {
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 16; ++i) {
      const bool left = i % 4 < 2;
      texels.insert(texels.end(), {std::uint8_t(left ? 255 : 0), std::uint8_t(left ? 0 : 255), 0,
                                   std::uint8_t(left ? 255 : 0)});
    }
    file.add("images", {{"uri", GltfWriter::data_uri(test::png_of(texels, 4), "image/png")}});
    file.add("textures", {{"source", 0}});
    material["pbrMetallicRoughness"]["baseColorTexture"] = std::move(info);
    primitive["material"] = file.add("materials", std::move(material));
  }
  std::vector<std::uint8_t> glb(json node = json::object()) {
    node["mesh"] = file.add("meshes", {{"primitives", {primitive}}, {"name", "face"}});
    file.add("scenes", {{"nodes", {file.add("nodes", std::move(node))}}});
    return file.glb();
  }
};

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
  file.add("meshes", {{"primitives", {primitive}}, {"extras", {{"targetNames", {"jawOpen"}}}}});
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

TEST(ReadHead, SkinsStandInTheirBindPose) {
  Square square;
  auto& attributes = square.primitive["attributes"];
  attributes["JOINTS_0"] = square.file.accessor(
      std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0}, "VEC4");
  attributes["WEIGHTS_0"] = square.file.accessor(
      std::vector<float>{0.5, 0.5, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  square.primitive["targets"] = {
      {{"POSITION", square.file.sparse(4, std::vector<std::uint8_t>{1},
                                       std::vector<float>{0, -1, 0}, "VEC3")}}};
  square.file.add("meshes",
                  {{"primitives", {square.primitive}}, {"extras", {{"targetNames", {"jawOpen"}}}}});
  std::vector<float> inverse;
  for (int joint = 0; joint < 4; ++joint) {
    inverse.insert(inverse.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  }
  inverse[16 + 13] = -1;  // the neck was bound one lower
  square.file.add("nodes", {{"mesh", 0}, {"skin", 0}, {"translation", {100, 100, 100}}});
  square.file.add("nodes", {{"name", "mixamorig:Spine"}, {"children", {2}}});
  square.file.add("nodes", {{"name", "mixamorig:Neck"},
                            {"children", {3}},
                            {"translation", {0, 3, 0}},
                            {"scale", {2, 2, 2}}});
  square.file.add("nodes", {{"name", "mixamorig:Head"}, {"children", {4, 5, 6}}});
  square.file.add("nodes", {{"name", "mixamorig:LeftEye"}, {"translation", {1, 2, 0}}});
  square.file.add("nodes", {{"name", "mixamorig:RightEye"}, {"translation", {-1, 2, 0}}});
  square.file.add("nodes", {{"name", "mixamorig:HeadTop_End"}, {"translation", {0, 9, 0}}});
  square.file.add("skins", {{"joints", {1, 2, 3, 4}},
                            {"inverseBindMatrices", square.file.accessor(inverse, "MAT4")}});
  square.file.add("scenes", {{"nodes", {0, 1}}});
  const head::Source source = read(square.file.glb());
  const head::Piece& piece = source.pieces.at(0);
  // Vertex 0: half at rest, half of (p - (0, 1, 0)) * 2 + (0, 3, 0) = (0, 1, 0).
  expect_near(piece.mesh.positions[0], {0, 0.5f, 0});
  expect_near(piece.mesh.positions[1], {2, 1, 0});
  expect_near(piece.mesh.positions[2], {2, 5, 0});
  EXPECT_EQ(piece.neck_weights, (std::vector<float>{0.25f, 0.5f, 1, 1}));
  expect_near(source.targets.at(0).deltas.at(0) * head::kFullShape, {0, -2, 0});
  ASSERT_TRUE(source.neck_pivot && source.eyes[0] && source.eyes[1]);
  expect_near(*source.neck_pivot, {0, 3, 0});
  expect_near(*source.eyes[0], {2, 7, 0});
  EXPECT_FALSE(source.jaw_axis);
}

TEST(ReadHead, BonesOfUsualRigs) {
  struct Rig {
    const char* head;
    const char* left;
    const char* right;
    const char* jaw;
  };
  for (const Rig& rig : {Rig{"Head", "LeftEye", "RightEye", ""},
                         Rig{"CC_Base_Head", "CC_Base_L_Eye", "CC_Base_R_Eye", "CC_Base_JawRoot"},
                         Rig{"J_Bip_C_Head", "J_Adj_L_FaceEye", "J_Adj_R_FaceEye", ""},
                         Rig{"head", "FACIAL_L_Eye", "FACIAL_R_Eye", "FACIAL_C_Jaw"},
                         Rig{"head", "eye.L", "eye.R", "jaw"},
                         Rig{"Bip01 Head", "Bip01 LEye", "Bip01 REye", "Bip01 MJaw"}}) {
    Square square;
    square.file.add("nodes", {{"name", "eyebrow.L"}, {"translation", {9, 9, 9}}});
    square.file.add("nodes", {{"name", rig.head}, {"translation", {0, 1, 0}}});
    square.file.add("nodes", {{"name", rig.left}, {"translation", {0, 2, 0}}});
    square.file.add("nodes", {{"name", rig.right}, {"translation", {0, 3, 0}}});
    square.file.add("nodes", {{"name", rig.jaw}, {"translation", {0, 4, 0}}});
    square.file.root["skins"] = {{{"joints", {0, 1, 2, 3, 4}}}};
    const head::Source source = read(square.glb());
    ASSERT_TRUE(source.neck_pivot && source.eyes[0] && source.eyes[1]) << rig.left;
    expect_near(*source.neck_pivot, {0, 1, 0});
    expect_near(*source.eyes[0], {0, 2, 0});
    expect_near(*source.eyes[1], {0, 3, 0});
    EXPECT_EQ(source.jaw_axis.has_value(), rig.jaw[0] != 0) << rig.jaw;
  }
}

TEST(ReadHead, VrmNamesItsBones) {
  Square square;
  for (int i = 0; i < 3; ++i) {
    square.file.add("nodes", {{"name", "bone" + std::to_string(i)}, {"translation", {0, i, 0}}});
  }
  square.file.root["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"] = {
      {"head", {{"node", 0}}}, {"leftEye", {{"node", 1}}}, {"rightEye", {{"node", 2}}}};
  const head::Source source = read(square.glb());
  ASSERT_TRUE(source.eyes[1]);
  expect_near(*source.eyes[1], {0, 2, 0});
}

TEST(ReadHead, VrmNamesItsExpressions) {
  for (const bool old : {true, false}) {
    Square square;
    const int moves =
        square.file.sparse(4, std::vector<std::uint8_t>{1}, std::vector<float>{0, -1, 0}, "VEC3");
    for (int i = 0; i < 4; ++i) square.primitive["targets"].push_back({{"POSITION", moves}});
    square.primitive["extras"] = {{"targetNames", {"kuchi1", "me2", "jawOpen", "kuchi3"}}};
    json& extensions = square.file.root["extensions"];
    if (old) {
      extensions["VRM"]["blendShapeMaster"]["blendShapeGroups"] = {
          {{"presetName", "a"}, {"binds", {{{"mesh", 0}, {"index", 0}, {"weight", 100}}}}},
          {{"presetName", "blink_l"}, {"binds", {{{"mesh", 0}, {"index", 1}, {"weight", 100}}}}},
          {{"presetName", "o"}, {"binds", {{{"mesh", 0}, {"index", 2}, {"weight", 100}}}}},
          {{"presetName", "u"}, {"binds", {{{"mesh", 0}, {"index", 3}, {"weight", 40}}}}}};
    } else {
      json& presets = extensions["VRMC_vrm"]["expressions"]["preset"];
      presets["aa"]["morphTargetBinds"] = {{{"node", 0}, {"index", 0}, {"weight", 1}}};
      presets["blinkLeft"]["morphTargetBinds"] = {{{"node", 0}, {"index", 1}, {"weight", 1}}};
      presets["oh"]["morphTargetBinds"] = {{{"node", 0}, {"index", 2}, {"weight", 1}}};
      presets["ou"]["morphTargetBinds"] = {{{"node", 0}, {"index", 3}, {"weight", 0.4}}};
    }
    const head::Source source = read(square.glb());
    ASSERT_EQ(source.shapes.size(), 3u);
    EXPECT_EQ(source.shapes[0].name, old ? "a" : "aa");
    EXPECT_EQ(source.shapes[1].name, old ? "blink_l" : "blinkLeft");
    EXPECT_EQ(source.shapes[2].name, "jawOpen");
  }
}

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
  square.file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const Error draco = error_of(square.glb());
  EXPECT_EQ(draco.code, Code::unsupported);
  EXPECT_THAT(draco.message, HasSubstr("Blender"));
  square.file.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  EXPECT_THAT(error_of(square.file.glb()).message, HasSubstr("gltfpack"));
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

}  // namespace
}  // namespace animeme::gltf
