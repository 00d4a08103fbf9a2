// Heads of others that have visemes, alone or beside ARKit's shapes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fap/arkit.h"
#include "fap/head/rig.h"
#include "fap/head/shapes.h"
#include "fap/tables.h"
#include "tests/view/gltf/actor_file.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {
namespace viseme_head_test {

using head::Part;
using head::Vec3;
using nlohmann::json;
using test::GltfWriter;

std::string morph_name(int viseme) { return std::string(fap::kVisemes[std::size_t(viseme)].morph); }

std::vector<NamedPose> visemes() {
  std::vector<NamedPose> poses;
  for (int viseme = 0; viseme < 15; ++viseme) {
    poses.push_back({morph_name(viseme), head::viseme_shape(viseme)});
  }
  return poses;
}

NamedPose blink() {
  NamedPose closed{"eyesClosed", {}};
  for (int fap = 19; fap <= 22; ++fap) closed.frame.set(fap, fap < 21 ? 995 : 29);
  return closed;
}

std::vector<NamedPose> visemes_and_blink() {
  std::vector<NamedPose> poses = visemes();
  poses.push_back(blink());
  return poses;
}

// The woman with shapes that are poses of hers.
head::Head woman_with(const std::vector<NamedPose>& poses) {
  GltfWriter file;
  json nodes = json::array();
  for (const Part part : {Part::skin, Part::left_eye, Part::right_eye}) {
    nodes.push_back(
        add_actor_part(file, part, std::string(head::kPartNames[std::size_t(part)]), poses));
  }
  file.add("scenes", {{"nodes", nodes}});
  auto source = read_head(file.glb());
  EXPECT_TRUE(source) << source.error().describe();
  auto head = head::assemble(std::move(*source));
  EXPECT_TRUE(head) << head.error().describe();
  return std::move(*head);
}

float weight(const head::Rig& rig, const fap::Frame& frame, std::string_view name) {
  const head::ControlValues values = head::control_values(rig, frame);
  for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
    if (rig.shapes[i].name == name) return values[head::kFirstShape + i] / head::kFullShape;
  }
  return -1;
}

fap::Frame fap_1(int viseme, int other = 0, int blend = 63) {
  fap::Frame frame;
  frame.mask.set(1);
  frame.viseme = {viseme, other, blend, false};
  return frame;
}

TEST(VisemeHead, Fap1ShowsItsOwnShapes) {
  const head::Rig& original = actor().rig;
  const head::Head head = woman_with(visemes_and_blink());
  EXPECT_EQ(head.shapes.size(), 15u);  // without silence, with closed eyes
  EXPECT_TRUE(head.point("2.1").exists());
  EXPECT_TRUE(head.point("3.1").exists());
  const head::Rig rig = head::make_rig(head);
  const float scale = head::length(rig.eyes[0].centre - rig.eyes[1].centre) /
                      head::length(original.eyes[0].centre - original.eyes[1].centre);
  double squares = 0, motion = 0;
  for (int viseme = 1; viseme < 15; ++viseme) {
    const fap::Frame frame = fap_1(viseme);
    const head::Pose is = head::pose(rig, frame), was = head::pose(original, frame);
    for (std::size_t v = 0; v < is.positions[0].size(); ++v) {
      const Vec3 wanted = (was.positions[0][v] - original.parts[0].positions[v]) * scale;
      const Vec3 off = is.positions[0][v] - rig.parts[0].positions[v] - wanted;
      squares += double(head::dot(off, off));
      motion += double(head::dot(wanted, wanted));
    }
    EXPECT_GT(weight(rig, frame, morph_name(viseme)), 0.5f) << viseme;
  }
  std::printf("visemes: %.1f %% of the motion is missing\n", 100 * std::sqrt(squares / motion));
  EXPECT_LT(std::sqrt(squares / motion), 0.1);
}

// As its maker made them, whatever the gain, half of one and half of another, with a mood.
TEST(VisemeHead, Fap1NeedsNoFit) {
  head::Rig rig = head::make_rig(woman_with(visemes_and_blink()));
  rig.mouth_gain = 2;
  EXPECT_FLOAT_EQ(weight(rig, fap_1(10), "viseme_aa"), 1);
  EXPECT_FLOAT_EQ(weight(rig, fap_1(10), "viseme_E"), 0);
  EXPECT_FLOAT_EQ(weight(rig, fap_1(10, 14, 21), "viseme_aa"), 1.0f / 3);
  EXPECT_FLOAT_EQ(weight(rig, fap_1(10, 14, 21), "viseme_U"), 2.0f / 3);
  EXPECT_FLOAT_EQ(weight(rig, fap_1(10, 0, 21), "viseme_aa"), 1.0f / 3);  // the rest is silence
  EXPECT_FLOAT_EQ(weight(rig, fap_1(7, 7, 21), "viseme_SS"), 1);
  fap::Frame blinking = fap_1(14);
  for (const int fap : {19, 20}) blinking.set(fap, 1024);
  EXPECT_FLOAT_EQ(weight(rig, blinking, "viseme_U"), 1);
  EXPECT_GT(weight(rig, blinking, "eyesClosed"), 0.9f);
}

// Where a frame has lips of its own, they win over the viseme, and are fitted.
TEST(VisemeHead, CodedLipsWinOverFap1) {
  const head::Rig rig = head::make_rig(woman_with(visemes_and_blink()));
  fap::Frame frame = head::viseme_shape(14);
  frame.mask.set(1);
  frame.viseme = {10, 0, 63, false};
  EXPECT_GT(weight(rig, frame, "viseme_U"), 0.5f);
  EXPECT_LT(weight(rig, frame, "viseme_aa"), 0.2f);
}

float said(const head::Rig& rig, const fap::Frame& frame, const fap::VisemeWeights& visemes,
           std::string_view name) {
  head::PoseOptions options;
  options.visemes = visemes;
  const head::ControlValues values = head::control_values(rig, frame, options);
  for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
    if (rig.shapes[i].name == name) return values[head::kFirstShape + i] / head::kFullShape;
  }
  return -1;
}

// What a script says is shown by the head's own visemes, whatever the lips of the frame are, with a
// blink; lips show in pauses.
TEST(VisemeHead, AScriptIsShownByItsOwnShapes) {
  const head::Rig rig = head::make_rig(woman_with(visemes_and_blink()));
  ASSERT_TRUE(head::has_own_visemes(rig));
  fap::Frame frame = head::viseme_shape(10);
  for (const int fap : {19, 20}) frame.set(fap, 1024);
  fap::VisemeWeights f{}, half{}, pause{};
  f[2] = 1;
  half[2] = half[14] = 0.5;
  pause[0] = 1;
  EXPECT_FLOAT_EQ(said(rig, frame, f, "viseme_FF"), 1);
  EXPECT_NEAR(said(rig, frame, f, "viseme_aa"), 0, 1e-6);
  EXPECT_GT(said(rig, frame, f, "eyesClosed"), 0.9f);
  EXPECT_FLOAT_EQ(said(rig, frame, half, "viseme_FF"), 0.5);
  EXPECT_FLOAT_EQ(said(rig, frame, half, "viseme_U"), 0.5);
  EXPECT_FLOAT_EQ(said(rig, frame, pause, "viseme_aa"), weight(rig, frame, "viseme_aa"));
  // One viseme of them missing: the lips of the frame.
  std::vector<NamedPose> poses = visemes_and_blink();
  poses.erase(poses.begin() + 3);
  const head::Rig fewer = head::make_rig(woman_with(poses));
  EXPECT_FALSE(head::has_own_visemes(fewer));
  EXPECT_FLOAT_EQ(said(fewer, frame, f, "viseme_FF"), weight(fewer, frame, "viseme_FF"));
  // The tongue of other heads goes between the teeth.
  fap::VisemeWeights th{};
  th[3] = 1;
  head::PoseOptions options;
  options.visemes = th;
  for (int fap = 43; fap <= 47; ++fap) frame.set(fap, 0);
  const head::ControlValues values = head::control_values(actor().rig, frame, options);
  EXPECT_EQ(values[45], float(head::viseme_shape(3).value[45]));
  EXPECT_EQ(values[3], float(frame.value[3]));
}

// A smile goes on while visemes are shown; what speech does with the corners does not make one.
TEST(VisemeHead, AMoodPullsTheCornersBesideVisemes) {
  std::vector<NamedPose> poses = visemes_and_blink();
  const auto shape_of = [](const char* name) {
    fap::ArkitFrame weights{};
    weights[std::size_t(*fap::find_arkit(name))] = 1;
    return fap::arkit_to_fap(weights, fap::kAllArkit);
  };
  for (const char* name : {"mouthSmileLeft", "mouthSmileRight"})
    poses.push_back({name, shape_of(name)});
  head::Rig rig = head::make_rig(woman_with(poses));
  for (const char* name : {"mouthFrownLeft", "mouthFrownRight"})
    rig.shapes.push_back({name, shape_of(name), fap::find_arkit(name), {}});
  ASSERT_TRUE(head::has_own_visemes(rig));
  fap::VisemeWeights open{}, half{};
  open[10] = 1;
  half[10] = half[0] = 0.5;
  const auto raised = [](int left, int right) {
    fap::Frame frame = head::viseme_shape(10);
    frame.set(12, left);
    frame.set(13, right);
    return frame;
  };
  EXPECT_GT(said(rig, raised(250, 250), open, "mouthSmileLeft"), 0.2f);
  EXPECT_EQ(said(rig, raised(250, 250), open, "mouthSmileLeft"),
            said(rig, raised(250, 250), open, "mouthSmileRight"));
  EXPECT_FLOAT_EQ(said(rig, raised(250, 250), open, "viseme_aa"), 1);
  EXPECT_GT(said(rig, raised(250, 0), open, "mouthSmileLeft"), 0.2f) << "an ironic one";
  EXPECT_EQ(said(rig, raised(250, 0), open, "mouthSmileRight"), 0);
  EXPECT_GT(said(rig, raised(-260, -260), open, "mouthFrownRight"), 0.1f);
  for (const int spoken : {90, 0, -140}) {
    for (const char* name : {"mouthSmileLeft", "mouthFrownLeft"})
      EXPECT_EQ(said(rig, raised(spoken, spoken), open, name), 0) << spoken;
  }
}

TEST(VisemeHead, BesideArkitVisemesAreForFap1Alone) {
  std::vector<NamedPose> poses = visemes();
  for (const char* name : {"jawOpen", "mouthFunnel", "mouthPucker", "mouthClose",
                           "mouthStretchLeft", "mouthStretchRight", "mouthUpperUpLeft",
                           "mouthUpperUpRight", "mouthLowerDownLeft", "mouthLowerDownRight"}) {
    fap::ArkitFrame weights{};
    weights[std::size_t(*fap::find_arkit(name))] = 1;
    poses.push_back({name, fap::arkit_to_fap(weights, fap::kAllArkit)});
  }
  poses.push_back(blink());
  const head::Rig rig = head::make_rig(woman_with(poses));
  EXPECT_FLOAT_EQ(weight(rig, fap_1(14), "viseme_U"), 1);
  EXPECT_FLOAT_EQ(weight(rig, fap_1(14), "mouthPucker"), 0);
  EXPECT_FLOAT_EQ(weight(rig, head::viseme_shape(10), "viseme_aa"), 0);
  EXPECT_GT(weight(rig, head::viseme_shape(10), "jawOpen"), 0.2f);
}

// A shape does what it does, not what its name says: one that is made half as strong, or that
// rounds and opens nothing.
TEST(VisemeHead, ShapesAreMeasured) {
  std::vector<NamedPose> poses = visemes_and_blink();
  const fap::Frame whole = poses[10].frame;
  for (const int fap : {3, 4, 5, 8, 9, 10, 11, 51, 52, 55, 56, 57, 58}) {
    poses[10].frame.set(fap, whole.value[std::size_t(fap)] / 2);
  }
  for (const int fap : {16, 17}) poses[14].frame.set(fap, 0);
  const head::Rig rig = head::make_rig(woman_with(poses));
  const auto shape = [&](std::string_view name) {
    return std::ranges::find(rig.shapes, name, &head::ShapeControl::name)->faps.value;
  };
  // The units of a head whose points are estimated differ.
  const double ratio = rig.fapu.mns / actor().rig.fapu.mns;
  EXPECT_NEAR(shape("viseme_aa")[5] * ratio, 0.5 * whole.value[5], 20);
  EXPECT_NEAR(shape("viseme_aa")[4] * ratio, 0.5 * whole.value[4], 20);
  EXPECT_NEAR(shape("viseme_U")[17] * ratio, 0, 30);  // 430 by its name
  EXPECT_LT(shape("viseme_U")[6], -100);
}

// Eyes that cannot blink have no lids, but tell how large the face is.
TEST(VisemeHead, AFaceWithoutABlinkHasAMouth) {
  const head::Head head = woman_with(visemes());
  EXPECT_FALSE(head.point("3.1").exists());
  for (const char* id : {"2.2", "2.3", "2.4", "2.5", "8.1", "8.2", "8.3", "8.4", "9.3"}) {
    ASSERT_TRUE(head.point(id).exists()) << id;
    const float scale = float(head.fapu.es / actor().head.fapu.es);
    EXPECT_LT(head::length(head.at(id) * (1 / scale) - actor().head.at(id)), 0.5f) << id;
  }
}

TEST(VisemeHead, AFaceWithoutABlinkIsMeasured) {
  const fap::Fapu without = woman_with(visemes()).fapu, with = woman_with(visemes_and_blink()).fapu;
  EXPECT_NEAR(without.mns, with.mns, 0.01);
  EXPECT_NEAR(without.mw, with.mw, 0.01);
  EXPECT_NEAR(without.ens, with.ens, 0.01);
}

// An upper lip that rises stretches the skin below the nose; that does not part.
TEST(VisemeHead, StretchedSkinIsNoMouth) {
  std::vector<NamedPose> poses = visemes_and_blink();
  for (const int fap : {4, 8, 9, 51, 55, 56}) poses[10].frame.set(fap, -700);
  poses[10].frame.set(17, 300);
  const head::Head head = woman_with(poses);
  const float scale = float(head.fapu.es / actor().head.fapu.es);
  for (const char* id : {"2.2", "2.3", "2.6", "2.7", "2.8", "2.9"}) {
    ASSERT_TRUE(head.point(id).exists()) << id;
    EXPECT_LT(head::length(head.at(id) * (1 / scale) - actor().head.at(id)), 0.3f) << id;
  }
}

TEST(VisemeHead, ItBlinks) {
  const head::Head head = woman_with(visemes_and_blink());
  const head::Rig rig = head::make_rig(head);
  fap::Frame frame;
  for (const int fap : {19, 20}) frame.set(fap, 1024);
  const head::Pose closed = head::pose(rig, frame);
  const head::FeaturePoint lid = head.point("3.1");
  EXPECT_LT(closed.positions[0][lid.vertex].y - rig.parts[0].positions[lid.vertex].y,
            -0.8f * float(head.fapu.irisd));
}

}  // namespace viseme_head_test
}  // namespace animeme::gltf
