// Names of morph targets.
#include "tools/view/gltf/shape_names.h"

#include <gmock/gmock.h>

#include "fap/arkit.h"
#include "fap/head/rig.h"
#include "fap/head/shapes.h"
#include "fap/tables.h"

namespace animeme::gltf {
namespace shape_names_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string arkit_of(std::string_view name) {
  const auto meaning = meaning_of(name);
  if (!meaning) return "unknown";
  if (meaning->set == ShapeSet::viseme) {
    return "viseme " + std::string(fap::kVisemes[std::size_t(meaning->viseme)].name);
  }
  std::string text;
  for (const ArkitPart& part : meaning->parts) {
    text += text.empty() ? "" : "+";
    text += std::string(fap::kArkitNames[std::size_t(part.channel)]);
    if (part.sides != 3) text += part.sides == 1 ? "(left half)" : "(right half)";
  }
  return text;
}

TEST(ShapeNames, SidesAndWordsInOtherPlaces) {
  for (const char* name : {"L_eyeBlink", "left_eye_blink", "eyeLeftBlink", "Left Eye Blink",
                           "eyeBlinkLft", "eyeBlinkLeft_bs", "eyeBlinkLeft.001", "eyeBlink_L_mesh",
                           "eyeBlink_L_2", "Head.leftEyeBlink_shape"}) {
    EXPECT_EQ(arkit_of(name), "eyeBlinkLeft") << name;
  }
  EXPECT_EQ(arkit_of("viseme_PP_bs"), arkit_of("viseme_PP"));
  EXPECT_EQ(arkit_of("mouthLeft_1"), "mouthLeft");
  EXPECT_EQ(arkit_of("mouthLeftSmile"), "mouthSmileLeft");
  for (const char* name :
       {"A_1", "hair_a_2", "E_mesh", "eye_left_right_blink", "left", "mesh_001"}) {
    EXPECT_EQ(arkit_of(name), "unknown") << name;
  }
}

// Whatever a figure is called.
TEST(ShapeNames, APrefixThatAllHave) {
  const std::vector<std::string> names = {"Emma_jawOpen", "Emma_mouthClose", "Emma_eyeBlink_L",
                                          "Emma_hairLong"};
  EXPECT_EQ(common_prefix(names), "Emma_");
  EXPECT_EQ(common_prefix({"My_Emma_jawOpen", "My_Emma_mouthClose", "My_Emma_eyeBlink_L"}),
            "My_Emma_");
  EXPECT_EQ(meaning_of("Emma_jawOpen", "Emma_")->faps, meaning_of("jawOpen")->faps);
  EXPECT_FALSE(meaning_of("Emma_jawOpen"));
  EXPECT_EQ(common_prefix({"jawOpen", "mouthClose", "mouthFunnel"}), "") << "they are known";
  EXPECT_EQ(common_prefix({"Emma_jawOpen", "Emma_mouthClose"}), "") << "these may be anything";
  EXPECT_EQ(
      common_prefix({"jawOpen", "combo_jawOpen", "combo_jawOpen_smile", "combo_a_b", "combo_b_c",
                     "combo_mouthClose", "combo_c", "combo_mouthFunnel", "combo_d"}),
      "")
      << "most are none";
  std::vector<std::string> notes;
  const auto shapes = choose_shapes(names, MouthShapes::automatic, notes);
  EXPECT_EQ(shapes.size(), 3u);
  EXPECT_THAT(unknown_names(names), ElementsAre("Emma_hairLong"));
}

TEST(ShapeNames, ArkitInAnySpelling) {
  for (const char* name :
       {"eyeBlinkLeft", "EyeBlinkLeft", "eyeBlink_L", "eye_blink_left", "Eye_Blink_L",
        "blendShape1.eyeBlinkLeft", "A14_Eye_Blink_Left", "ARKit_eyeBlinkLeft", "ARKitEyeBlinkLeft",
        "AK_01_eyeBlinkLeft", "head_mesh:eyeBlinkLeft", "EYEBLINKLEFT", "Eye Blink Left",
        "eyeBlink.L", "Face.eyeBlink_L"}) {
    EXPECT_EQ(arkit_of(name), "eyeBlinkLeft") << name;
  }
  for (int shape = 0; shape < fap::kArkitShapeCount; ++shape) {
    const std::string name(fap::kArkitNames[std::size_t(shape)]);
    EXPECT_EQ(arkit_of(name), name);
  }
  EXPECT_EQ(arkit_of("browInnerUp_L"), "browInnerUp(left half)");
  EXPECT_EQ(arkit_of("cheekPuff_R"), "cheekPuff(right half)");
  EXPECT_EQ(arkit_of("headYaw"), "unknown");
}

TEST(ShapeNames, Visemes) {
  for (const fap::VisemeInfo& row : fap::kVisemes) {
    EXPECT_EQ(arkit_of(row.morph), "viseme " + std::string(row.name));
  }
  for (const char* name :
       {"PP", "v_PP", "vrc.v_pp", "V_PP", "visemePP", "Viseme_PP", "blendShape.viseme_PP"}) {
    EXPECT_EQ(arkit_of(name), "viseme PP") << name;
  }
  EXPECT_EQ(arkit_of("vrc.v_oh"), "viseme oh");
  EXPECT_EQ(arkit_of("Face.M_F00_000_00_Fcl_MTH_A"), "viseme aa");
  EXPECT_EQ(arkit_of("Fcl_MTH_U"), "viseme ou");
  EXPECT_EQ(arkit_of("う"), "viseme ou");
  EXPECT_EQ(arkit_of("ee"), "viseme E");
}

TEST(ShapeNames, OtherUsualNames) {
  EXPECT_EQ(arkit_of("eyesClosed"), "eyeBlinkLeft+eyeBlinkRight");
  EXPECT_EQ(arkit_of("Face.M_F00_000_00_Fcl_BRW_Angry"), "browDownLeft+browDownRight");
  EXPECT_EQ(arkit_of("Fcl_BRW_Sorrow"), "browInnerUp");
  EXPECT_EQ(arkit_of("Fcl_BRW_Joy"), "browOuterUpLeft+browOuterUpRight");
  EXPECT_EQ(arkit_of("Fcl_EYE_Surprised"), "eyeWideLeft+eyeWideRight");
  EXPECT_EQ(arkit_of("困る"), "browInnerUp");
  EXPECT_EQ(arkit_of("Blink"), "eyeBlinkLeft+eyeBlinkRight");
  EXPECT_EQ(arkit_of("Fcl_EYE_Close_R"), "eyeBlinkRight");
  EXPECT_EQ(arkit_of("まばたき"), "eyeBlinkLeft+eyeBlinkRight");
  EXPECT_EQ(arkit_of("mouthOpen"), "jawOpen");
  EXPECT_EQ(arkit_of("mouthSmile"), "mouthSmileLeft+mouthSmileRight");
  EXPECT_EQ(arkit_of("eyesLookUp"), "eyeLookUpLeft+eyeLookUpRight");
  EXPECT_EQ(arkit_of("eyesLookLeft"), "eyeLookOutLeft+eyeLookInRight");
  for (const char* name : {"", "_", "target 3", "mouth", "jaw", "thirdEye", "x.y.z", "Basis"}) {
    EXPECT_EQ(arkit_of(name), "unknown") << name;
  }
}

TEST(ShapeNames, HalvesAreOneWhole) {
  const auto left = meaning_of("browInnerUp_L"), right = meaning_of("browInnerUp_R");
  const auto whole = meaning_of("browInnerUp");
  ASSERT_TRUE(left && right && whole);
  for (std::size_t fap = 3; fap <= 68; ++fap) {
    EXPECT_NEAR(left->faps.value[fap] + right->faps.value[fap], whole->faps.value[fap], 1) << fap;
  }
  EXPECT_EQ(left->faps.value[32], 0);
  EXPECT_GT(left->faps.value[31], 0);
}

std::vector<std::string> chosen(const std::vector<std::string>& names, MouthShapes mouth,
                                std::vector<std::string>* notes = nullptr) {
  std::vector<std::string> said;
  std::vector<std::string> out;
  for (const ChosenShape& shape : choose_shapes(names, mouth, said)) out.push_back(shape.name);
  if (notes != nullptr) *notes = said;
  return out;
}

const std::vector<std::string> kBoth = {
    "jawOpen",         "mouthClose",     "mouthFunnel",   "mouthPucker", "mouthSmileLeft",
    "mouthSmileRight", "mouthRollLower", "viseme_sil",    "viseme_aa",   "viseme_O",
    "eyesClosed",      "eyeBlinkLeft",   "eyeBlinkRight", "mouthOpen",   "tail"};

TEST(ShapeNames, ArkitGoesBeforeVisemesAndOtherNames) {
  std::vector<std::string> notes;
  EXPECT_THAT(chosen(kBoth, MouthShapes::automatic, &notes),
              ElementsAre("jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthSmileLeft",
                          "mouthSmileRight", "mouthRollLower", "viseme_aa", "viseme_O",
                          "eyeBlinkLeft", "eyeBlinkRight"));
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_THAT(notes[0], HasSubstr("eyesClosed"));
  EXPECT_THAT(notes[1], HasSubstr("tail"));
}

TEST(ShapeNames, VisemesWhenWantedOrAlone) {
  EXPECT_THAT(chosen(kBoth, MouthShapes::visemes),
              ElementsAre("mouthSmileLeft", "mouthSmileRight", "viseme_aa", "viseme_O",
                          "eyeBlinkLeft", "eyeBlinkRight"));
  EXPECT_THAT(chosen({"A", "I", "eyesClosed", "mouthSmile"}, MouthShapes::automatic),
              ElementsAre("A", "I", "eyesClosed", "mouthSmile"));
}

// Where visemes open the mouth a frown, or a lip rolled in, would bend them.
TEST(ShapeNames, VisemesAreNotBent) {
  EXPECT_THAT(
      chosen({"A", "U", "mouthFrownLeft", "mouthFrownRight", "mouthRollLower", "mouthPucker"},
             MouthShapes::automatic),
      ElementsAre("A", "U", "mouthPucker"));
  EXPECT_THAT(chosen({"jawOpen", "mouthFrownLeft"}, MouthShapes::automatic),
              ElementsAre("jawOpen", "mouthFrownLeft"));
}

TEST(ShapeNames, TwoNamesOfOneShapeAreOne) {
  std::vector<std::string> notes;
  const auto shapes =
      choose_shapes({"jawOpen", "Jaw_Open", "tongueOut"}, MouthShapes::automatic, notes);
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_THAT(shapes[0].names, ElementsAre(0u, 1u));
  EXPECT_TRUE(notes.empty());
}

TEST(ShapeNames, Moods) {
  const auto mood = [](std::string_view name) {
    const auto meaning = meaning_of(name);
    return meaning ? meaning->mood : -1;
  };
  for (const char* name : {"joy", "happy", "Happy", "Face.M_F00_000_00_Fcl_ALL_Joy"}) {
    EXPECT_EQ(mood(name), 1) << name;
  }
  for (const char* name : {"sorrow", "sad", "Fcl_ALL_Sorrow"}) EXPECT_EQ(mood(name), 2) << name;
  for (const char* name : {"angry", "Fcl_ALL_Angry"}) EXPECT_EQ(mood(name), 3) << name;
  for (const char* name : {"surprised", "Fcl_ALL_Surprised"}) EXPECT_EQ(mood(name), 6) << name;
  EXPECT_EQ(mood("fun"), mood("relaxed"));
  EXPECT_EQ(mood("Fcl_MTH_Joy"), -1);
  EXPECT_EQ(mood("Fcl_BRW_Joy"), 0);  // brows alone
  EXPECT_THAT(chosen({"A", "I", "joy", "fun", "angry"}, MouthShapes::automatic),
              ElementsAre("A", "I", "joy", "fun", "angry"));
  std::vector<std::string> with_arkit = kBoth;
  with_arkit.push_back("joy");
  EXPECT_THAT(chosen(with_arkit, MouthShapes::automatic), testing::Contains("joy")) << "for FAP 2";
  with_arkit.back() = "relaxed";
  EXPECT_THAT(chosen(with_arkit, MouthShapes::automatic),
              testing::Not(testing::Contains("relaxed")));
}

// A mood is shown by its own shape; a sound is not, though a smile is in both.
TEST(ShapeNames, MoodsAreShownAndKeepOutOfSpeech) {
  std::vector<std::string> names = {"blink", "happy", "sad", "angry", "surprised", "relaxed"};
  for (const char* vowel : {"A", "I", "U", "E", "O"}) names.push_back(vowel);
  std::vector<std::string> notes;
  head::Rig rig;
  for (const ChosenShape& shape : choose_shapes(names, MouthShapes::automatic, notes)) {
    rig.shapes.push_back(control_of(shape));
  }
  const auto weight = [&](const fap::Frame& frame, std::string_view name) {
    const head::ControlValues values = head::control_values(rig, frame);
    for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
      if (rig.shapes[i].name == name) return values[head::kFirstShape + i] / head::kFullShape;
    }
    return -1.0f;
  };
  for (const auto& [expression, name] :
       {std::pair{1, "happy"}, {2, "sad"}, {3, "angry"}, {6, "surprised"}}) {
    fap::Frame frame;
    frame.mask.set(2);
    frame.expression = {expression, 63, 0, 0, false, false};
    EXPECT_GT(weight(frame, name), 0.9f) << name;
    frame.expression.intensity1 = 30;
    EXPECT_NEAR(weight(frame, name), 0.48f, 0.1f) << name;
  }
  for (const int viseme : {10, 11, 12, 13, 14, 1, 4, 7}) {
    for (const char* name : {"happy", "sad", "angry", "surprised", "relaxed"}) {
      EXPECT_LT(weight(head::viseme_shape(viseme), name), 0.2f) << viseme << name;
    }
  }
}

// FAPs by name and number, but the turns of the head and what only looks like one.
TEST(ShapeNames, Faps) {
  const std::pair<const char*, int> names[] = {
      {"open_jaw", 3},      {"FAP3", 3},   {"fap_03_open_jaw", 3}, {"Mesh.raise_b_midlip", 5},
      {"3_open_jaw", 3},    {"FAP68", 68}, {"yaw_l_eyeball", 23},  {"stretch_r_cornerlip_o", 54},
      {"FAP2", 0},          {"FAP69", 0},  {"head_yaw", 0},        {"FAP49", 0},
      {"fap4_open_jaw", 0}, {"fap", 0},    {"FAP99999999999", 0}};
  for (const auto& [name, fap] : names) {
    const auto meaning = meaning_of(name);
    EXPECT_EQ(meaning ? meaning->fap : 0, fap) << name;
    if (!meaning) continue;
    EXPECT_EQ(meaning->faps.mask.count(), 1u) << name;
    EXPECT_GT(meaning->faps.value[std::size_t(fap)], 0) << name;
  }
  EXPECT_EQ(meaning_of("jawOpen")->fap, 0);
}

}  // namespace shape_names_test
}  // namespace animeme::gltf
