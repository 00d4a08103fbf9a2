// Heads as glTF files: their structure, read by hand.
#include "tools/view/gltf/glb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "fap/arkit.h"
#include "tests/view/gltf/actor.h"

namespace animeme::gltf {
namespace glb_test {

using nlohmann::json;

struct Glb {
  json root;
  std::vector<std::uint8_t> binary;

  std::vector<float> floats(int accessor) const {
    const json& entry = root["accessors"][std::size_t(accessor)];
    const json& view = root["bufferViews"][entry["bufferView"].get<std::size_t>()];
    std::vector<float> values(view["byteLength"].get<std::size_t>() / 4);
    std::memcpy(values.data(), binary.data() + view["byteOffset"].get<std::size_t>(),
                values.size() * 4);
    return values;
  }
  const json& mesh(const std::string& name) const {
    for (const json& entry : root["meshes"]) {
      if (entry["name"] == name) return entry;
    }
    ADD_FAILURE() << "no mesh " << name;
    return root;
  }
  // Values of the animation of a node.
  std::vector<float> animated(const std::string& node, const std::string& path) const {
    const json& animation = root["animations"][0];
    for (const json& channel : animation["channels"]) {
      const json& target = channel["target"];
      if (target["path"] != path) continue;
      if (root["nodes"][target["node"].get<std::size_t>()]["name"] != node) continue;
      return floats(animation["samplers"][channel["sampler"].get<std::size_t>()]["output"]);
    }
    ADD_FAILURE() << node << " has no " << path;
    return {};
  }
};

std::uint32_t word(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

Glb parse(const std::vector<std::uint8_t>& file) {
  Glb glb;
  EXPECT_EQ(word(file, 0), 0x46546C67u);
  EXPECT_EQ(word(file, 8), file.size());
  const std::uint32_t length = word(file, 12);
  glb.root = json::parse(file.begin() + 20, file.begin() + 20 + length);
  glb.binary.assign(file.begin() + 28 + length, file.end());
  EXPECT_EQ(word(file, 20 + length), glb.binary.size());
  return glb;
}

// Mouth opens in three frames, the head turns left by 0.3 rad, the eyes right.
fap::Sequence clip() {
  fap::Sequence out{{25, 1}, {}, "x"};
  for (int i = 0; i < 3; ++i) {
    fap::ArkitFrame weights{};
    weights[std::size_t(*fap::find_arkit("jawOpen"))] = 0.3 * i;
    weights[std::size_t(*fap::find_arkit("eyeLookOutRight"))] = 0.2 * i;
    fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
    frame.number = 10 + i * 2;
    frame.set(49, 15000 * i);
    out.frames.push_back(frame);
  }
  return out;
}

TEST(Glb, ArkitTargetsHaveNamesAndTheAnimationTheirWeights) {
  const auto file = make_glb(actor().head, actor().rig, clip(), {.audio = "voice.wav"});
  ASSERT_TRUE(file);
  const Glb glb = parse(*file);
  const json names = glb.mesh("skin")["extras"]["targetNames"];
  const std::set<std::string> all(names.begin(), names.end());
  for (const char* name : {"jawOpen", "mouthSmileLeft", "eyeBlinkRight", "browInnerUp"}) {
    EXPECT_TRUE(all.count(name)) << name;
  }
  EXPECT_EQ(glb.mesh("skin")["primitives"][0]["targets"].size(), names.size());
  const std::vector<float> weights = glb.animated("skin", "weights");
  ASSERT_EQ(weights.size(), 3 * names.size());
  const auto jaw = std::size_t(std::find(names.begin(), names.end(), "jawOpen") - names.begin());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(weights[i * names.size() + jaw], 0.3 * double(i), 0.1);  // a fit
  }
  EXPECT_EQ(glb.root["scenes"][0]["extras"]["audio"], "voice.wav");
}

TEST(Glb, KeysLieAtTheTimesOfTheFrames) {
  const auto file = make_glb(actor().head, actor().rig, clip());
  ASSERT_TRUE(file);
  const Glb glb = parse(*file);
  const json& sampler = glb.root["animations"][0]["samplers"][0];
  const std::vector<float> times = glb.floats(sampler["input"]);
  ASSERT_EQ(times.size(), 3u);
  EXPECT_NEAR(times[1], 0.08, 1e-6);
  EXPECT_NEAR(times[2], 0.16, 1e-6);
}

TEST(Glb, TheNeckTurnsAndTheJawGoesDown) {
  const auto file = make_glb(actor().head, actor().rig, clip());
  ASSERT_TRUE(file);
  const Glb glb = parse(*file);
  const std::vector<float> neck = glb.animated("neck_bone", "rotation");
  ASSERT_EQ(neck.size(), 12u);
  EXPECT_NEAR(neck[9], std::sin(0.15), 1e-4);  // about +Y, half the angle
  EXPECT_NEAR(neck[11], std::cos(0.15), 1e-4);
  const std::vector<float> jaw = glb.animated("jaw_bone", "rotation");
  EXPECT_GT(jaw[8], 0.01);  // about +X: the chin goes down
  const std::vector<float> eye = glb.animated("right_eye_bone", "rotation");
  EXPECT_LT(eye[9], -0.05);  // to the right, in the head
}

TEST(Glb, FapTargetsAreUnitsOf1024) {
  const auto file = make_glb(actor().head, actor().rig, clip(), {.morphs = MorphNames::fap});
  ASSERT_TRUE(file);
  const Glb glb = parse(*file);
  const json names = glb.mesh("skin")["extras"]["targetNames"];
  const auto at = std::find(names.begin(), names.end(), "open_jaw") - names.begin();
  ASSERT_LT(std::size_t(at), names.size());
  const std::vector<float> weights = glb.animated("skin", "weights");
  EXPECT_NEAR(weights[2 * names.size() + std::size_t(at)], double(clip().frames[2].value[3]) / 1024,
              1e-5);
}

TEST(Glb, EveryAccessorLiesInItsBuffer) {
  const auto file = make_glb(actor().head, actor().rig, clip(), {.normals = true});
  ASSERT_TRUE(file);
  const Glb glb = parse(*file);
  for (const json& view : glb.root["bufferViews"]) {
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
              glb.binary.size());
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
  }
  EXPECT_FALSE(glb.mesh("skin")["primitives"][0]["targets"][0]["NORMAL"].is_null());
}

TEST(Glb, NoMotionIsAnError) {
  const auto file = make_glb(actor().head, actor().rig, {});
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, Code::invalid_argument);
}

TEST(Glb, SameBytesEachTime) {
  EXPECT_EQ(*make_glb(actor().head, actor().rig, clip()),
            *make_glb(actor().head, actor().rig, clip()));
}

}  // namespace glb_test
}  // namespace animeme::gltf
