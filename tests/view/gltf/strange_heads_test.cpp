// Heads as strangers make them: names of other programs, words within names, mirrored files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "fap/arkit.h"
#include "fap/head/rig.h"
#include "tests/support/files.h"
#include "tests/support/shared.h"
#include "tests/view/gltf/actor_file.h"
#include "tools/view/gltf/read_head.h"
#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace strange_heads_test {

using head::Part;
using head::Vec3;
using nlohmann::json;
using test::GltfWriter;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

struct Target {
  std::string name;   // in the file
  std::string shape;  // of ARKit: what it does
  double full = 1;
};

const std::vector<Target> kUsual = {{"eyeBlinkLeft", "eyeBlinkLeft"},
                                    {"eyeBlinkRight", "eyeBlinkRight"},
                                    {"jawOpen", "jawOpen"},
                                    {"mouthClose", "mouthClose"},
                                    {"mouthFunnel", "mouthFunnel"},
                                    {"mouthPucker", "mouthPucker"},
                                    {"mouthSmileLeft", "mouthSmileLeft"},
                                    {"mouthSmileRight", "mouthSmileRight"},
                                    {"mouthUpperUpLeft", "mouthUpperUpLeft"},
                                    {"mouthUpperUpRight", "mouthUpperUpRight"}};

struct FileOptions {
  std::string mesh = "skin", material = "skin";
  bool mirrored = false;
  bool vrm0 = false;  // looks along -Z
};

fap::Frame face(std::string_view shape, double weight = 1) {
  fap::ArkitFrame weights{};
  weights[std::size_t(fap::find_arkit(shape).value_or(0))] = weight;
  return fap::arkit_to_fap(weights, fap::kAllArkit);
}

std::vector<std::uint8_t> woman_file(const std::vector<Target>& targets,
                                     const FileOptions& options = {}) {
  std::vector<NamedPose> poses;
  for (const Target& target : targets) {
    poses.push_back({target.name, face(target.shape, target.full)});
  }
  GltfWriter file;
  json nodes = json::array();
  for (const Part part : {Part::skin, Part::left_eye, Part::right_eye}) {
    const bool skin = part == Part::skin;
    const std::string name(head::kPartNames[std::size_t(part)]);
    const int material = file.add("materials", {{"name", skin ? options.material : name}});
    nodes.push_back(add_actor_part(file, part, skin ? options.mesh : name, poses, material));
  }
  json root = {{"name", "root"}, {"children", nodes}};
  if (options.mirrored) root["scale"] = {-1, 1, 1};
  if (options.vrm0) {
    root["rotation"] = {0, 1, 0, 0};
    file.root["extensions"]["VRM"] = {{"specVersion", "0.0"}};
    file.root["extensionsUsed"] = {"VRM"};
  }
  file.add("scenes", {{"nodes", {file.add("nodes", root)}}});
  return file.glb();
}

struct Loaded {
  head::Head head;
  std::vector<std::string> notes;
};

std::optional<Loaded> loaded(const std::vector<std::uint8_t>& file) {
  auto source = read_head(file);
  EXPECT_TRUE(source) << source.error().describe();
  if (!source) return std::nullopt;
  Loaded out;
  auto head = head::assemble(std::move(*source), &out.notes);
  EXPECT_TRUE(head) << head.error().describe();
  if (!head) return std::nullopt;
  out.head = std::move(*head);
  return out;
}

std::vector<std::string> shapes_of(const head::Head& head) {
  std::vector<std::string> names;
  for (const head::ShapeControl& shape : head.shapes) names.push_back(shape.name);
  return names;
}

// How far the lower lip goes down for a jaw that opens, of the mouth's height at rest.
float opening(const head::Head& head) {
  const head::Rig rig = head::make_rig(head);
  const head::Pose open = head::pose(rig, face("jawOpen"));
  float most = 0;
  for (std::size_t v = 0; v < open.positions[0].size(); ++v) {
    most = std::max(most, rig.parts[0].positions[v].y - open.positions[0][v].y);
  }
  return most / float(rig.fapu.es);
}

// As Ready Player Me writes it: a mouthOpen of its own stands before jawOpen.
TEST(StrangeHeads, TheOrderOfNamesDoesNotMatter) {
  std::vector<Target> first = kUsual, last = kUsual;
  first.insert(first.begin(), {"mouthOpen", "jawOpen", 0.4});
  last.push_back({"mouthOpen", "jawOpen", 0.4});
  const auto plain = loaded(woman_file(kUsual));
  const auto before = loaded(woman_file(first)), behind = loaded(woman_file(last));
  ASSERT_TRUE(plain && before && behind);
  for (const auto& one : {before, behind}) {
    EXPECT_THAT(shapes_of(one->head), Contains("jawOpen"));
    EXPECT_THAT(shapes_of(one->head), Not(Contains("mouthOpen")));
    EXPECT_THAT(one->notes, Contains(HasSubstr("mouthOpen"))) << "what is unused is told";
    EXPECT_NEAR(opening(one->head), opening(plain->head), 1e-3);
  }
}

// A mouth that opens within the skin, while the chin stays: a jaw that drops opens it.
TEST(StrangeHeads, AMouthWithoutAChinIsOpenedByTheJaw) {
  std::vector<Target> targets = kUsual;
  std::erase_if(targets, [](const Target& target) { return target.name == "jawOpen"; });
  targets.push_back({"mouthOpen", "mouthLowerDownLeft"});
  const auto head = loaded(woman_file(targets));
  ASSERT_TRUE(head);
  const head::Rig rig = head::make_rig(head->head);
  const auto shape = std::find_if(rig.shapes.begin(), rig.shapes.end(),
                                  [](const auto& one) { return one.name == "mouthOpen"; });
  ASSERT_NE(shape, rig.shapes.end());
  EXPECT_TRUE(shape->faps.mask[3]);
  EXPECT_GT(shape->faps.value[3], 100);
}

TEST(StrangeHeads, WordsWithinWordsSayNothing) {
  using head::part_by_name;
  for (const char* name : {"Christopher_Head", "Christopher", "Chatbot", "Somebody", "Cheyenne",
                           "Gummibear", "Handsome", "Facet", "Whatever", "Stephanie"}) {
    EXPECT_EQ(part_by_name(name, ""), Part::skin) << name;
  }
  // As before: words, compounds, plurals.
  const std::pair<const char*, Part> kKnown[] = {{"Wolf3D_Teeth", Part::lower_teeth},
                                                 {"M_ScleraLeft", Part::left_eye},
                                                 {"eyelashes", Part::lashes},
                                                 {"Std_Eyelash", Part::lashes},
                                                 {"upperteeth", Part::upper_teeth},
                                                 {"Wolf3D_Outfit_Top", Part::body},
                                                 {"F00_000_HairBack_00_HAIR", Part::hair},
                                                 {"EyeLeft", Part::left_eye},
                                                 {"eyeballs", Part::left_eye},
                                                 {"FaceBrow", Part::brows},
                                                 {"haircards", Part::hair},
                                                 {"Tops_01_CLOTH", Part::body},
                                                 {"tshirt", Part::body},
                                                 {"Std_Skin_Body", Part::body},
                                                 {"sunglasses", Part::hair},
                                                 {"EyeIris_00", Part::left_eye}};
  for (const auto& [name, part] : kKnown) EXPECT_EQ(part_by_name(name, ""), part) << name;
}

// The mesh whose shapes move lips and lids is the face, whatever it is called.
TEST(StrangeHeads, TheFaceIsWhatShapesMove) {
  for (const char* name : {"Body", "Iris", "Hat", "top", "Eye", "Std_Hair", "Tear"}) {
    const auto head = loaded(woman_file(kUsual, {name, name}));
    ASSERT_TRUE(head) << name;
    EXPECT_FALSE(head->head.part(Part::skin).triangles.empty()) << name;
    EXPECT_GT(opening(head->head), 0.3f) << name;
    EXPECT_TRUE(head->head.point("2.2").exists()) << name;
  }
}

// Without shapes names are all there is; the error says which.
TEST(StrangeHeads, ErrorsNameMeshMaterialAndWord) {
  auto source = read_head(woman_file({}, {"Outfit", "M_Jacket"}));
  ASSERT_TRUE(source);
  const auto head = head::assemble(std::move(*source));
  ASSERT_FALSE(head);
  for (const char* part : {"\"Outfit\"", "\"M_Jacket\"", "\"jacket\""}) {
    EXPECT_THAT(head.error().message, HasSubstr(part));
  }
}

std::string told(std::string_view name) {
  const auto meaning = meaning_of(name);
  if (!meaning) return "unknown";
  if (meaning->viseme >= 0) return "viseme " + std::to_string(meaning->viseme);
  std::string text;
  for (const ArkitPart& part : meaning->parts) {
    text += (text.empty() ? "" : "+") + std::string(fap::kArkitNames[std::size_t(part.channel)]);
    if (part.sides != 3) text += part.sides == 1 ? " left" : " right";
    if (part.lips != 3) text += part.lips == 1 ? " upper" : " lower";
  }
  return text;
}

TEST(StrangeHeads, NamesOfOtherHouses) {
  const std::pair<const char*, const char*> kNames[] = {
      {"Mouth_Down_Lower_L", "mouthLowerDownLeft"},
      {"Mouth_Up_Upper_R", "mouthUpperUpRight"},
      {"Mouth_Roll_In_Lower", "mouthRollLower"},
      {"Mouth_Roll_In_Upper_L", "mouthRollUpper left"},
      {"Mouth_Funnel_Up_L", "mouthFunnel left upper"},
      {"Brow_Raise_Outer_R", "browOuterUpRight"},
      {"Eye_L_Look_R", "eyeLookInLeft"},
      {"V_Open", "viseme 10"},
      {"V_Explosive", "viseme 1"},
      {"V_Dental_Lip", "viseme 2"},
      {"V_Tight_O", "viseme 14"},
      {"MouthCornerPullLeft", "mouthSmileLeft"},
      {"EyeClosedRight", "eyeBlinkRight"},
      {"LipFunnelLowerRight", "mouthFunnel right lower"},
      {"LipSuckUpper", "mouthRollUpper"},
      {"Eye_Left_Blink", "eyeBlinkLeft"},
      {"Mouth_Ape_Shape", "mouthClose"},
      {"Mouth_Pout", "mouthPucker"},
      {"Mouth_Upper_UpLeft", "mouthUpperUpLeft"},
      {"Mouth_Sad_Right", "mouthFrownRight"},
      {"LipsTogether", "mouthClose"},
      {"LipsLowerDown", "mouthLowerDownLeft+mouthLowerDownRight"},
      {"LipsStretch_L", "mouthStretchLeft"},
      {"BrowsU_C", "browInnerUp"},
      {"ChinLowerRaise", "mouthShrugLower"},
      {"eCTRLvAA", "viseme 10"},
      {"facs_bs_JawOpen_div2", "jawOpen"},
      {"facs_ctrl_EyeBlinkLeft", "eyeBlinkLeft"},
      {"h_expressions.LeyeClose_h", "eyeBlinkLeft"},
      {"h_expressions.MPB_Up_h", "viseme 1"},
      {"h_expressions.Kiss_h", "mouthPucker"},
      {"JawDrop", "jawOpen"},
      {"LeftUpperLidClosed", "eyeBlinkLeft"},
      {"head_lod0_mesh__jawOpen", "jawOpen"},
      {"BlendShape.JawOpen", "jawOpen"},
      {"Body|mouthSmile_L", "mouthSmileLeft"}};
  for (const auto& [name, shape] : kNames) EXPECT_EQ(told(name), shape) << name;
  for (const char* name : {"unknown_bro16", "x1", "Spine", "Key 1", "hair_up", "v", "h"}) {
    EXPECT_EQ(told(name), "unknown") << name;
  }
}

// Four quarters are a whole.
TEST(StrangeHeads, QuartersAddUp) {
  const auto whole = meaning_of("LipFunnel");
  ASSERT_TRUE(whole);
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    int sum = 0;
    for (const char* name : {"LipFunnelUpperLeft", "LipFunnelUpperRight", "LipFunnelLowerLeft",
                             "LipFunnelLowerRight"}) {
      sum += meaning_of(name)->faps.value[std::size_t(f)];
    }
    EXPECT_NEAR(sum, whole->faps.value[std::size_t(f)], 4) << f;
  }
  std::vector<std::string> notes;
  const auto shapes = choose_shapes({"LipFunnelUpperLeft", "LipFunnelUpperRight",
                                     "LipFunnelLowerLeft", "LipFunnelLowerRight", "JawOpen"},
                                    MouthShapes::automatic, notes);
  EXPECT_EQ(shapes.size(), 5u);
}

// A whole head with the names of another house moves as with ARKit's.
TEST(StrangeHeads, AHeadOfAnotherHouseMoves) {
  const std::vector<Target> creator = {{"Eye_Blink_L", "eyeBlinkLeft"},
                                       {"Eye_Blink_R", "eyeBlinkRight"},
                                       {"Jaw_Open", "jawOpen"},
                                       {"Mouth_Close", "mouthClose"},
                                       {"Mouth_Funnel", "mouthFunnel"},
                                       {"Mouth_Pucker", "mouthPucker"},
                                       {"Mouth_Smile_L", "mouthSmileLeft"},
                                       {"Mouth_Smile_R", "mouthSmileRight"},
                                       {"Mouth_Up_Upper_L", "mouthUpperUpLeft"},
                                       {"Mouth_Up_Upper_R", "mouthUpperUpRight"}};
  const auto head = loaded(woman_file(creator)), usual = loaded(woman_file(kUsual));
  ASSERT_TRUE(head && usual);
  ASSERT_EQ(head->head.shapes.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(head->head.shapes[i].arkit, usual->head.shapes[i].arkit) << i;
  }
  EXPECT_NEAR(opening(head->head), opening(usual->head), 1e-4);
}

float weight(const head::Rig& rig, const fap::Frame& frame, std::string_view name) {
  const head::ControlValues values = head::control_values(rig, frame);
  for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
    if (rig.shapes[i].name == name) return values[head::kFirstShape + i] / head::kFullShape;
  }
  ADD_FAILURE() << name;
  return -1;
}

// A chin that nobody measured is 0 in filled frames and absent in others; a gain opens both alike.
TEST(StrangeHeads, AGainIsTheSameForFilledFrames) {
  const auto loaded_head = loaded(woman_file(kUsual));
  ASSERT_TRUE(loaded_head);
  head::Rig rig = head::make_rig(loaded_head->head);
  fap::Frame bare = face("jawOpen", 0.3);
  for (const std::size_t fap : {14, 18, 39, 40, 41, 42}) {
    bare.mask.reset(fap);
    bare.value[fap] = 0;
  }
  fap::Frame filled = bare;
  for (const int fap : {14, 18, 39, 40, 41, 42}) filled.set(fap, 0);
  for (const double gain : {1.0, 1.7, 3.0}) {
    rig.mouth_gain = gain;
    for (const Target& target : kUsual) {
      EXPECT_NEAR(weight(rig, bare, target.name), weight(rig, filled, target.name), 1e-3)
          << target.name << " at " << gain;
    }
  }
  rig.mouth_gain = 2;
  EXPECT_GT(weight(rig, filled, "jawOpen"), 0.5f);
  EXPECT_LT(weight(rig, filled, "mouthUpperUpLeft"), 0.1f);
}

// Lids alone are a blink, with and without shapes that turn the eyes and take lids along.
TEST(StrangeHeads, LidsAloneAreABlink) {
  std::vector<Target> more = kUsual;
  for (const char* name : {"eyeLookUpLeft", "eyeLookDownLeft", "eyeLookInLeft", "eyeLookOutLeft",
                           "eyeWideLeft", "eyeSquintLeft", "cheekPuff", "mouthFrownLeft"}) {
    more.push_back({name, name});
  }
  for (const std::vector<Target>& targets : {kUsual, more}) {
    const auto loaded_head = loaded(woman_file(targets));
    ASSERT_TRUE(loaded_head);
    const head::Rig rig = head::make_rig(loaded_head->head);
    fap::Frame closed;
    for (const int fap : {19, 20}) closed.set(fap, 1024);
    for (const int fap : {21, 22}) closed.set(fap, 0);
    for (const Target& target : targets) {
      const bool blink = target.name.starts_with("eyeBlink");
      EXPECT_NEAR(weight(rig, closed, target.name), blink ? 1 : 0, 0.03) << target.name;
    }
  }
}

// A mirrored file shows its face, not its back.
TEST(StrangeHeads, MirroredFilesLookForwards) {
  const auto plain = loaded(woman_file(kUsual));
  const auto mirrored = loaded(woman_file(kUsual, {.mirrored = true}));
  ASSERT_TRUE(plain && mirrored);
  EXPECT_THAT(mirrored->notes, Not(Contains(HasSubstr("does not look"))));
  for (const char* id : {"3.1", "3.2", "2.2", "2.3", "9.3"}) {
    ASSERT_TRUE(mirrored->head.point(id).exists()) << id;
    EXPECT_GT(mirrored->head.at(id).z, 0) << id;
  }
  EXPECT_NEAR(mirrored->head.at("9.3").z, plain->head.at("9.3").z, 0.2);
  // Its left eye, as the file says, is on the right.
  const head::Rig rig = head::make_rig(mirrored->head);
  const head::Pose blink = head::pose(rig, face("eyeBlinkLeft"));
  float moved[2] = {};
  for (std::size_t v = 0; v < blink.positions[0].size(); ++v) {
    const Vec3 from = rig.parts[0].positions[v];
    float& side = moved[from.x > 0 ? 0 : 1];
    side = std::max(side, from.y - blink.positions[0][v].y);
  }
  EXPECT_GT(moved[1], 5 * moved[0]);
}

// Whole bodies, too, whose skin lies as much before the face as behind it.
TEST(StrangeHeads, MirroredBodiesLookForwards) {
  const auto folder = test::shared_dir() / "data" / "avatars";
  if (test::shared_dir().empty() || !std::filesystem::exists(folder)) {
    GTEST_SKIP() << "no reference data";
  }
  for (const char* name : {"brunette-t.glb", "vroid.glb"}) {
    const auto bytes = test::read_bytes(folder / name);
    ASSERT_GT(bytes.size(), 20u);
    std::uint32_t size = 0;
    std::memcpy(&size, &bytes[12], 4);
    auto root = json::parse(bytes.begin() + 20, bytes.begin() + 20 + size);
    auto& roots = root["scenes"][root.value("scene", std::size_t(0))]["nodes"];
    root["nodes"].push_back({{"scale", {-1, 1, 1}}, {"children", roots}});
    roots = json::array({root["nodes"].size() - 1});
    std::string text = root.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<std::uint8_t> file(bytes.begin(), bytes.begin() + 20);
    const auto put = [&](std::size_t at, std::size_t value) {
      const auto word = std::uint32_t(value);
      std::memcpy(&file[at], &word, 4);
    };
    put(8, bytes.size() - size + text.size());
    put(12, text.size());
    file.insert(file.end(), text.begin(), text.end());
    file.insert(file.end(), bytes.begin() + 20 + size, bytes.end());
    const auto mirrored = loaded(file);
    ASSERT_TRUE(mirrored) << name;
    EXPECT_THAT(mirrored->notes, Not(Contains(HasSubstr("does not look")))) << name;
  }
}

// VRM 0 looks along -Z, as it should.
TEST(StrangeHeads, VrmZeroIsToldNothing) {
  const auto head = loaded(woman_file(kUsual, {.vrm0 = true}));
  ASSERT_TRUE(head);
  EXPECT_THAT(head->notes, Not(Contains(HasSubstr("does not look"))));
  EXPECT_GT(head->head.at("9.3").z, head->head.at("3.1").z);
}

}  // namespace strange_heads_test
}  // namespace animeme::gltf
