// Skins, bones and what VRM says of them.
#include <cmath>

#include "tests/view/gltf/square.h"

namespace animeme::gltf {
namespace head_bones_test {

using nlohmann::json;

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

}  // namespace head_bones_test
}  // namespace animeme::gltf
