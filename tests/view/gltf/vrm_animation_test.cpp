// The motion of an avatar of VRM 1.0 as a file of its own.
#include "tools/view/gltf/vrm_animation.h"

#include <gmock/gmock.h>

#include "tests/view/gltf/avatar_file.h"
#include "tools/view/gltf/detail/nodes.h"

namespace animeme::gltf {
namespace vrm_animation_test {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The crooked head, with the bones and expressions that VRM 1.0 names.
struct Avatar : Crooked {
  Avatar() {
    json& vrm = file.root["extensions"]["VRMC_vrm"];
    vrm["specVersion"] = "1.0";
    for (const auto& [name, node] : std::map<std::string, int>{
             {"hips", 1}, {"neck", 2}, {"head", 3}, {"leftEye", 4}, {"rightEye", 5}}) {
      vrm["humanoid"]["humanBones"][name] = {{"node", node}};
    }
    const auto expression = [](int target, double weight) {
      return json{{"morphTargetBinds", {{{"node", 0}, {"index", target}, {"weight", weight}}}}};
    };
    vrm["expressions"]["preset"] = {{"blink", expression(2, 1)}, {"lookUp", expression(0, 1)}};
    vrm["expressions"]["custom"] = {{"Jaw", expression(0, 0.5)}};
  }
};

std::vector<float> keys(const Parts& file, const json& node, const char* path) {
  return file.keys(file.root["animations"][0], node["node"].get<std::size_t>(), path);
}

TEST(VrmAnimation, HasTheSkeletonExpressionsAndGaze) {
  const NamedClip clips[] = {{"talk", talk()}, {"talk", talk(2)}};
  const Bytes avatar = Avatar().file.glb();
  const auto made = vrm_animation(avatar, clips);
  ASSERT_TRUE(made) << made.error().describe();
  EXPECT_THAT(made->names, ElementsAre("talk", "talk 2"));
  EXPECT_THAT(made->expressions, ElementsAre("blink", "Jaw"));
  const Parts file(made->file);
  const json& vrma = file.root["extensions"]["VRMC_vrm_animation"];
  EXPECT_EQ(vrma["specVersion"], "1.0");
  const json& bones = vrma["humanoid"]["humanBones"];
  EXPECT_FALSE(bones.contains("leftEye"));  // the gaze turns it
  // Places are those of the avatar, upright.
  File old, now;
  old.root = to_read(Parts(avatar).root);
  now.root = to_read(file.root);
  const auto before = read_nodes(old), after = read_nodes(now);
  for (const auto& [name, node] : std::map<std::string, std::size_t>{{"hips", 1}, {"head", 3}}) {
    const Node& bone = (*after)[bones[name]["node"].get<std::size_t>()];
    expect_near(head::Vec3(bone.world.origin()), head::Vec3((*before)[node].world.origin()), 1e-5f);
    expect_near(head::Vec3(bone.world.direction({1, 0, 0})), {1, 0, 0}, 1e-6f);
  }
  // Neck and head together turn as the clip says.
  const auto neck = keys(file, bones["neck"], "rotation"),
             head = keys(file, bones["head"], "rotation");
  ASSERT_EQ(neck.size(), 20u);
  EXPECT_EQ(neck, head);
  const double angle = std::sqrt(0.12 * 0.12 + 0.2 * 0.2 + 0.04 * 0.04);
  EXPECT_NEAR(4 * std::acos(double(neck[19])), angle, 0.01);
  // A jaw that is half open at an expression of 1 needs twice as much of it, but no more than that.
  const auto plain = animate_file(avatar, {clips, 1});
  const Parts moved(whole(plain));
  const auto weights = moved.keys(moved.root["animations"][0], 0, "weights");
  const auto jaw = keys(file, vrma["expressions"]["custom"]["Jaw"], "translation");
  const auto blink = keys(file, vrma["expressions"]["preset"]["blink"], "translation");
  for (std::size_t f = 0; f < 5; ++f) {
    EXPECT_FLOAT_EQ(jaw[3 * f], std::min(1.0f, 2 * weights[3 * f]));
    EXPECT_FLOAT_EQ(blink[3 * f], weights[3 * f + 2]);
  }
  EXPECT_GT(jaw[3], 0.1f);
  // Eyes look to the left (+X) and down, by the middle of both.
  const auto gaze = keys(file, vrma["lookAt"], "rotation");
  ASSERT_EQ(gaze.size(), 20u);
  EXPECT_NEAR(2 * std::asin(double(gaze[17])), 0.07, 1e-3);
  EXPECT_NEAR(2 * std::asin(double(gaze[16])), 0.02, 1e-3);
}

TEST(VrmAnimation, MistakesAreNamed) {
  const NamedClip clips[] = {{"talk", talk()}};
  const auto other = vrm_animation(Crooked().file.glb(), clips);
  EXPECT_EQ(other.error().code, Code::unsupported);
  EXPECT_THAT(other.error().message, HasSubstr("VRM 1.0"));
  EXPECT_EQ(vrm_animation(Avatar().file.glb(), {}).error().code, Code::invalid_argument);
  Avatar mute;
  mute.file.root["extensions"]["VRMC_vrm"].erase("expressions");
  EXPECT_EQ(vrm_animation(mute.file.glb(), clips).error().code, Code::not_found);
  // Numbers that point nowhere.
  Avatar wrong;
  json& vrm = wrong.file.root["extensions"]["VRMC_vrm"];
  vrm["humanoid"]["humanBones"]["hips"]["node"] = 99;
  vrm["expressions"]["custom"]["Jaw"]["morphTargetBinds"][0]["index"] = 99;
  const auto made = vrm_animation(wrong.file.glb(), clips);
  ASSERT_TRUE(made);
  EXPECT_THAT(made->expressions, ElementsAre("blink"));
  EXPECT_THAT(made->notes, ::testing::Contains(HasSubstr("without an expression of their own")));
}

}  // namespace vrm_animation_test
}  // namespace animeme::gltf
