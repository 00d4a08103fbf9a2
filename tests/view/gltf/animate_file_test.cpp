// Avatars there and back: the file as it was, and the motion that the head shows.
#include "tools/view/gltf/animate_file.h"

#include <gmock/gmock.h>

#include "tests/view/gltf/avatar_file.h"
#include "tools/view/gltf/detail/nodes.h"

namespace animeme::gltf {
namespace animate_file_test {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(AnimateFile, KeepsAllThatWasThere) {
  const NamedClip clips[] = {{"talk", talk()}, {"old", talk(3)}, {"talk", talk(2)}};
  const auto file = animate_file(woman(), clips);
  const Bytes bytes = whole(file);
  expect_kept(woman(), bytes);
  EXPECT_EQ(file->names, (std::vector<std::string>{"talk", "old 2", "talk 2"}));
  EXPECT_EQ(Parts(bytes).root["animations"].size(), 4u);
  // A second time, on what was written.
  expect_kept(bytes, whole(animate_file(bytes, {clips, 1})));
  EXPECT_EQ(bytes, whole(animate_file(woman(), clips)));
}

// The same head made anew: what it shows is known.
TEST(AnimateFile, MovesAsTheHeadDoes) {
  const fap::Sequence clip = talk();
  const NamedClip clips[] = {{"talk", clip}};
  const Parts file(whole(animate_file(woman(), clips)));
  auto source = read_head(woman());
  ASSERT_TRUE(source);
  const auto head = head::assemble(std::move(*source));
  ASSERT_TRUE(head);
  const head::Rig rig = head::make_rig(*head);
  const json& animation = file.root["animations"][1];
  EXPECT_EQ(animation["name"], "talk");
  const std::size_t skin = file.node("skin");
  const json& mesh = file.root["meshes"][file.root["nodes"][skin]["mesh"].get<std::size_t>()];
  const json& names = mesh["extras"]["targetNames"];
  const std::vector<float> weights = file.keys(animation, skin, "weights");
  ASSERT_EQ(weights.size(), clip.frames.size() * names.size());
  double most = 0;
  for (std::size_t f = 0; f < clip.frames.size(); ++f) {
    const head::ControlValues values = head::control_values(rig, clip.frames[f]);
    for (std::size_t t = 0; t < names.size(); ++t) {
      std::size_t shape = 0;
      while (rig.shapes[shape].name != names[t]) ++shape;
      const float is = weights[f * names.size() + t];
      EXPECT_FLOAT_EQ(is, values[head::kFirstShape + shape] / head::kFullShape) << names[t];
      most = std::max(most, double(is));
    }
  }
  EXPECT_GT(most, 0.5);
  // Bones are those of a file that is written for this clip at once.
  const Parts anew(*make_glb(actor().head, actor().rig, clip));
  for (const char* bone : {"neck_bone", "left_eye_bone", "right_eye_bone"}) {
    const auto is = file.keys(animation, file.node(bone), "rotation");
    const auto wanted = anew.keys(anew.root["animations"][0], anew.node(bone), "rotation");
    ASSERT_EQ(is.size(), wanted.size()) << bone;
    for (std::size_t i = 0; i < is.size(); ++i) EXPECT_NEAR(is[i], wanted[i], 1e-5) << bone;
  }
}

Affine turned(const Parts& file, const json& animation, std::size_t frame, std::size_t node) {
  json nodes = file.root["nodes"];
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto keys = file.keys(animation, i, "rotation");
    if (keys.empty()) continue;
    nodes[i]["rotation"] =
        std::vector<float>(keys.begin() + long(4 * frame), keys.begin() + long(4 * frame) + 4);
  }
  File copy;
  copy.root = to_read({{"nodes", nodes}});
  return (*read_nodes(copy))[node].world;
}

TEST(AnimateFile, TurnsBonesWhoseParentsStandAskew) {
  const Bytes before = Crooked().file.glb();
  const NamedClip clips[] = {{"talk", talk()}};
  const auto animated = animate_file(before, clips);
  const Parts file(whole(animated));
  EXPECT_THAT(animated->notes, ::testing::Contains(HasSubstr("in the place of its matrix")));
  EXPECT_THAT(animated->notes, ::testing::Contains(HasSubstr("names of its shapes")));
  EXPECT_FALSE(file.root["nodes"][3].contains("matrix"));
  const json& animation = file.root["animations"][0];
  File old;
  old.root = to_read(Parts(before).root);
  const std::vector<Node> nodes = *read_nodes(old);
  for (std::size_t f = 0; f < 5; ++f) {
    const fap::Frame& frame = clips[0].clip.frames[f];
    const auto angle = [&](std::size_t fap) { return float(frame.value[fap]) * 1e-5f; };
    const head::Transform turn = head::rotation_about({}, angle(48), angle(49), angle(50));
    const head::Transform gaze = head::rotation_about({}, angle(25), angle(23), 0);
    for (const std::size_t node : {3, 4}) {
      const Affine is = turned(file, animation, f, node);
      const head::Transform wanted = node == 3 ? turn : head::compose(turn, gaze);
      for (const head::Vec3d axis : {head::Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
        const auto place = head::Vec3(is.direction(axis));
        expect_near(place, wanted.turn(head::Vec3(nodes[node].world.direction(axis))), 2e-5f);
      }
    }
  }
  // What is not known stays where its maker put it.
  const auto weights = file.keys(animation, 0, "weights");
  ASSERT_EQ(weights.size(), 15u);
  for (std::size_t f = 0; f < 5; ++f) EXPECT_FLOAT_EQ(weights[3 * f + 1], 0.25f);
  EXPECT_GT(weights[12], 0.5f);
}

TEST(AnimateFile, TakesASoundAlong) {
  const NamedClip clips[] = {{"talk", talk(), FileSound{"audio/wav", {1, 2, 3}}, "voice.wav"}};
  const Bytes before = Crooked().file.glb();
  const Parts file(whole(animate_file(before, clips)));
  const json& audio = file.root["extensions"]["KHR_audio_emitter"];
  EXPECT_EQ(audio["audio"][0]["mimeType"], "audio/wav");
  const json& view = file.root["bufferViews"][audio["audio"][0]["bufferView"].get<std::size_t>()];
  EXPECT_EQ(view["byteLength"], 3);
  EXPECT_EQ(file.binary[view["byteOffset"].get<std::size_t>() + 2], 3);
  EXPECT_EQ(file.root["scenes"][0]["extensions"]["KHR_audio_emitter"]["emitters"],
            json::array({0}));
  EXPECT_EQ(file.root["extensionsUsed"], json::array({"KHR_audio_emitter"}));
  EXPECT_FALSE(file.root.contains("extensionsRequired"));
  EXPECT_EQ(file.root["animations"][0]["extras"]["audio"], "voice.wav");
}

TEST(AnimateFile, TextGetsABufferOfItsOwn) {
  Crooked crooked;
  const std::string text = crooked.file.gltf("my%20face.bin");
  const NamedClip clips[] = {{"talk", talk()}};
  AnimateOptions options;
  options.reading.load = [&](const std::string& name) -> Result<Bytes> {
    EXPECT_EQ(name, "my face.bin");
    return crooked.file.binary;
  };
  const Bytes bytes(text.begin(), text.end());
  const Bytes out = whole(animate_file(bytes, clips, options));
  const json root = json::parse(out.begin(), out.end());
  ASSERT_EQ(root["buffers"].size(), 2u);
  EXPECT_EQ(root["buffers"][0]["uri"], "my%20face.bin");
  EXPECT_THAT(root["buffers"][1]["uri"].get<std::string>(), HasSubstr("data:application/octet"));
  EXPECT_EQ(root["bufferViews"].back()["buffer"], 1);
}

TEST(AnimateFile, CompressedMeshesMoveByName) {
  Crooked crooked;
  crooked.file.root["extensionsRequired"] = {"MADE_UP_compression"};
  const Bytes before = crooked.file.glb();
  const NamedClip clips[] = {{"talk", talk()}};
  const auto file = animate_file(before, clips);
  EXPECT_THAT(file->notes, ::testing::Contains(HasSubstr("MADE_UP_compression")));
  EXPECT_EQ(file->meshes, 1u);
}

TEST(AnimateFile, MistakesAreNamed) {
  const Bytes before = Crooked().file.glb();
  EXPECT_EQ(animate_file(before, {}).error().code, Code::invalid_argument);
  const NamedClip empty[] = {{"talk", fap::Sequence{{25, 1}, {}, "x"}}};
  EXPECT_EQ(animate_file(before, empty).error().code, Code::invalid_argument);
  const NamedClip clips[] = {{"talk", talk()}};
  const auto no_shape = animate_file(Square().glb(), clips);
  ASSERT_FALSE(no_shape);
  EXPECT_EQ(no_shape.error().code, Code::not_found);
  EXPECT_THAT(no_shape.error().message, HasSubstr("--points"));
  Bytes cut = before;
  cut.resize(cut.size() - 4);
  EXPECT_EQ(animate_file(cut, clips).error().code, Code::truncated);
  Crooked wrong;
  wrong.file.root["animations"] = 3;
  EXPECT_EQ(animate_file(wrong.file.glb(), clips).error().code, Code::syntax);
}

}  // namespace animate_file_test
}  // namespace animeme::gltf
