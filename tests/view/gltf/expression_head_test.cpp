// Heads of others that have whole faces for joy, anger and the like: FAP 2 shows them, and the
// mouth speaks beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fap/head/rig.h"
#include "fap/head/shapes.h"
#include "fap/tables.h"
#include "tests/view/gltf/actor_file.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {
namespace expression_head_test {

using head::Part;
using head::Vec3;
using nlohmann::json;
using test::GltfWriter;

constexpr int kJoy = 1, kSurprise = 6;

// The woman with visemes, a blink, and two whole faces of her maker.
const head::Rig& rig() {
  static const head::Rig made = [] {
    std::vector<NamedPose> poses;
    for (int viseme = 0; viseme < 15; ++viseme) {
      poses.push_back(
          {std::string(fap::kVisemes[std::size_t(viseme)].morph), head::viseme_shape(viseme)});
    }
    NamedPose closed{"eyesClosed", {}};
    for (int fap = 19; fap <= 22; ++fap) closed.frame.set(fap, fap < 21 ? 995 : 29);
    poses.push_back(closed);
    poses.push_back({"Fcl_ALL_Joy", head::expression_shape(kJoy)});
    poses.push_back({"surprised", head::expression_shape(kSurprise)});
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
    return head::make_rig(*head);
  }();
  return made;
}

float weight(const fap::Frame& frame, std::string_view name) {
  const head::ControlValues values = head::control_values(rig(), frame);
  for (std::size_t i = 0; i < rig().shapes.size(); ++i) {
    if (rig().shapes[i].name == name) return values[head::kFirstShape + i] / head::kFullShape;
  }
  ADD_FAILURE() << name;
  return -1;
}

fap::Frame with_mood(fap::Frame frame, int first, int intensity, int second = 0, int other = 0) {
  frame.mask.set(2);
  frame.expression = {first, intensity, second, other, false, false};
  return frame;
}

// A frame of speech with the lips of a viseme, every FAP of the mouth in it.
fap::Frame spoken(int viseme) {
  fap::Frame frame;
  const fap::Frame shape = head::viseme_shape(viseme);
  for (const fap::FapInfo& info : fap::kFaps) {
    const auto f = std::size_t(info.number);
    if (info.group == 2 || info.group == 8) frame.set(info.number, shape.value[f]);
  }
  return frame;
}

// Largest distance between two poses of the skin, of vertices above or below the nose.
float apart(const head::Pose& a, const head::Pose& b, bool above) {
  const auto& rest = rig().parts[0].positions;
  const float eyes = 0.5f * (rig().eyes[0].centre.y + rig().eyes[1].centre.y);
  const float nose = eyes - float(rig().fapu.ens), mns = float(rig().fapu.mns);
  float most = 0;
  for (std::size_t v = 0; v < rest.size(); ++v) {
    const bool counts =
        above ? rest[v].y > nose + 0.5f * float(rig().fapu.ens) : rest[v].y < nose - 0.5f * mns;
    if (counts) most = std::max(most, length(a.positions[0][v] - b.positions[0][v]));
  }
  return most;
}

TEST(ExpressionHead, Fap2AloneShowsTheWholeFaceOfItsMaker) {
  const fap::Frame joy = with_mood({}, kJoy, 63);
  EXPECT_FLOAT_EQ(weight(joy, "Fcl_ALL_Joy"), 1);
  EXPECT_FLOAT_EQ(weight(joy, "surprised"), 0);
  EXPECT_FLOAT_EQ(weight(joy, "eyesClosed"), 0);
  const fap::Frame both = with_mood({}, kSurprise, 21, kJoy, 42);
  EXPECT_FLOAT_EQ(weight(both, "surprised"), 1.0f / 3);
  EXPECT_FLOAT_EQ(weight(both, "Fcl_ALL_Joy"), 2.0f / 3);
  // Of which there is none: by FAPs, as before.
  const fap::Frame fear = with_mood({}, 4, 63);
  EXPECT_GT(apart(head::pose(rig(), fear), head::pose(rig(), fap::Frame{}), true), 0.0f);
}

TEST(ExpressionHead, TheMouthSpeaksBesideIt) {
  const float mns = float(rig().fapu.mns);
  for (const int viseme : {1, 2, 10, 14}) {
    const fap::Frame plain = spoken(viseme);
    for (const int mood : {kJoy, kSurprise}) {
      const fap::Frame moody = with_mood(plain, mood, 63);
      EXPECT_FLOAT_EQ(weight(moody, mood == kJoy ? "Fcl_ALL_Joy" : "surprised"), 0);
      EXPECT_FLOAT_EQ(weight(moody, mood == kJoy ? "Fcl_ALL_Joy.upper" : "surprised.upper"), 1);
      const head::Pose is = head::pose(rig(), moody), was = head::pose(rig(), plain);
      EXPECT_LT(apart(is, was, false), 0.02f * mns) << mood << ' ' << viseme;
      const head::Pose whole = head::pose(rig(), with_mood({}, mood, 63));
      EXPECT_LT(apart(is, whole, true), 0.1f * mns) << mood << ' ' << viseme;
      EXPECT_GT(apart(is, was, true), 0.1f * mns) << mood << ' ' << viseme;
    }
  }
}

TEST(ExpressionHead, VisemesOfFap1SpeakBesideIt) {
  for (const int viseme : {1, 2, 14}) {
    fap::Frame plain;
    plain.mask.set(1);
    plain.viseme = {viseme, 0, 63, false};
    const head::Pose was = head::pose(rig(), plain);
    const head::Pose is = head::pose(rig(), with_mood(plain, kSurprise, 63));
    EXPECT_LT(apart(is, was, false), 0.02f * float(rig().fapu.mns)) << viseme;
    EXPECT_GT(apart(is, was, true), 0.1f * float(rig().fapu.mns)) << viseme;
  }
}

TEST(ExpressionHead, CodedBrowsWinOverFap2) {
  fap::Frame brows = with_mood(spoken(10), kJoy, 63);
  for (int fap = 31; fap <= 36; ++fap) brows.set(fap, 100);
  EXPECT_FLOAT_EQ(weight(brows, "Fcl_ALL_Joy"), 0);
  EXPECT_FLOAT_EQ(weight(brows, "Fcl_ALL_Joy.upper"), 0);
}

}  // namespace expression_head_test
}  // namespace animeme::gltf
