// Arms that a file stretches out.
#include <gtest/gtest.h>

#include <algorithm>

#include "fap/head/rig.h"
#include "tests/support/gltf_writer.h"
#include "tests/view/gltf/actor.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {
namespace arms_test {

using head::Part;
using head::Vec3;
using nlohmann::json;
using test::GltfWriter;

struct Names {
  const char* arm;
  const char* forearm;
  const char* hand;
};

// A head with two arms: upper arm, forearm and a hand with a box around it.
std::vector<std::uint8_t> file_with(const Names& left, const Names& right, Vec3 along) {
  GltfWriter file;
  const head::Rig::Shape& skin = actor().rig.parts[std::size_t(Part::skin)];
  std::vector<float> places;
  for (const Vec3& v : skin.positions) places.insert(places.end(), {v.x, v.y, v.z});
  std::vector<std::uint32_t> corners;
  for (const head::Triangle& t : skin.triangles) corners.insert(corners.end(), t.begin(), t.end());
  const auto mesh = [&](const char* name, const std::vector<float>& positions,
                        const std::vector<std::uint32_t>& triangles) {
    const json primitive = {{"attributes", {{"POSITION", file.accessor(positions, "VEC3")}}},
                            {"indices", file.accessor(triangles, "SCALAR")}};
    return file.add("meshes", {{"name", name}, {"primitives", json::array({primitive})}});
  };
  const int face = file.add("nodes", {{"name", "skin"}, {"mesh", mesh("skin", places, corners)}});
  const int box = mesh("body", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2, 0, 2, 3, 0, 3, 1});
  json roots = {face};
  for (const auto& [names, side] : {std::pair(left, 1.0f), {right, -1.0f}}) {
    const auto at = [&, side = side](float scale) {
      return json{side * along.x * scale, along.y * scale, along.z * scale};
    };
    const int hand =
        file.add("nodes", {{"name", names.hand}, {"mesh", box}, {"translation", at(25)}});
    const int forearm =
        file.add("nodes", {{"name", names.forearm}, {"translation", at(30)}, {"children", {hand}}});
    roots.push_back(file.add(
        "nodes",
        {{"name", names.arm}, {"translation", {side * 18, -20, 0}}, {"children", {forearm}}}));
  }
  file.add("scenes", {{"nodes", roots}});
  return file.glb();
}

// Where the hands are: the left one's first corner, then the right one's.
std::vector<Vec3> hands(const std::vector<std::uint8_t>& file) {
  const auto source = read_head(file);
  EXPECT_TRUE(source) << source.error().describe();
  std::vector<Vec3> found;
  if (!source) return found;
  for (const head::Piece& piece : source->pieces) {
    if (piece.mesh.positions.size() == 4) found.push_back(piece.mesh.positions[0]);
  }
  EXPECT_EQ(found.size(), 2u);
  found.resize(2);
  return found;
}

constexpr Names kLeft[] = {{"LeftArm", "LeftForeArm", "LeftHand"},
                           {"mixamorig:LeftArm", "mixamorig:LeftForeArm", "mixamorig:LeftHand"},
                           {"upperarm_l", "lowerarm_l", "hand_l"},
                           {"CC_Base_L_Upperarm", "CC_Base_L_Forearm", "CC_Base_L_Hand"},
                           {"J_Bip_L_UpperArm", "J_Bip_L_LowerArm", "J_Bip_L_Hand"}};
constexpr Names kRight[] = {{"RightArm", "RightForeArm", "RightHand"},
                            {"mixamorig:RightArm", "mixamorig:RightForeArm", "mixamorig:RightHand"},
                            {"upperarm_r", "lowerarm_r", "hand_r"},
                            {"CC_Base_R_Upperarm", "CC_Base_R_Forearm", "CC_Base_R_Hand"},
                            {"J_Bip_R_UpperArm", "J_Bip_R_LowerArm", "J_Bip_R_Hand"}};

TEST(Arms, HangWhateverTheirBonesAreCalled) {
  for (std::size_t i = 0; i < std::size(kLeft); ++i) {
    for (const Vec3 along : {Vec3{1, 0, 0}, {0.8f, -0.6f, 0}, {0.9f, 0.3f, 0.2f}}) {
      const std::vector<Vec3> at = hands(file_with(kLeft[i], kRight[i], along));
      for (const Vec3 hand : at) {
        EXPECT_LT(std::abs(hand.x), 18 + 0.3f * 55) << kLeft[i].arm;
        EXPECT_LT(hand.y, -20 - 0.9f * 50) << kLeft[i].arm;
      }
      EXPECT_GT(at[0].x, 18);
      EXPECT_LT(at[1].x, -18);
      EXPECT_NEAR(at[0].y, at[1].y, 1e-3f);
    }
  }
}

TEST(Arms, ThatHangOrPointForwardsStay) {
  const std::vector<Vec3> hanging = hands(file_with(kLeft[0], kRight[0], {0.1f, -1, 0}));
  EXPECT_NEAR(hanging[0].y, -75, 1e-3f);
  EXPECT_NEAR(hanging[0].x, 23.5f, 1e-3f);
  const std::vector<Vec3> forwards = hands(file_with(kLeft[0], kRight[0], {0.2f, 0, 0.95f}));
  EXPECT_NEAR(forwards[0].y, -20, 1e-3f);
}

// No arm: names that have the word, and bones without a hand below.
TEST(Arms, OtherBonesStay) {
  for (const Names& names : {Names{"Armature_L", "x", "y"}, Names{"LeftArmor", "LeftForeArm", "z"},
                             Names{"LeftArm", "x", "y"}}) {
    const std::vector<Vec3> at = hands(file_with(names, {"a", "b", "c"}, {1, 0, 0}));
    EXPECT_NEAR(at[0].y, -20, 1e-3f) << names.arm;
  }
}

}  // namespace arms_test
}  // namespace animeme::gltf
