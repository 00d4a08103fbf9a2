// Rigs as bytes: what comes back moves as before, and damage is found before it is used.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "fap/head/rig.h"
#include "tools/view/viewer/rig/packed_rig.h"

namespace animeme::test {
namespace packed_rig_test {

using head::Part;
using head::Rig;
using head::Vec3;
using viewer::detail::pack_rig;
using viewer::detail::unpack_rig;

constexpr std::uint32_t kVertices = 24;

struct Dice {
  std::mt19937 engine{7};

  float number(float low, float high) { return low + (high - low) * float(engine() % 1000) / 1000; }
  Vec3 point() { return {number(-4, 4), number(-4, 4), number(-4, 4)}; }
};

std::vector<std::uint32_t> every_third() {
  std::vector<std::uint32_t> list;
  for (std::uint32_t v = 1; v < kVertices; v += 3) list.push_back(v);
  return list;
}

head::Target target_of(int control, Dice& dice) {
  head::Target target;
  target.control = control;
  target.vertices = every_third();
  for (std::size_t i = 0; i < target.vertices.size(); ++i) {
    target.deltas.push_back({0, dice.number(-0.001f, 0.001f), dice.number(-0.001f, 0.001f)});
  }
  return target;
}

// A sheet of skin that has some of everything.
Rig small_rig() {
  Dice dice;
  Rig rig;
  Rig::Shape& skin = rig.parts[std::size_t(Part::skin)];
  for (std::uint32_t v = 0; v < kVertices; ++v) {
    skin.positions.push_back(dice.point());
    rig.neck_weights.push_back(float(v) / (kVertices - 1));
  }
  skin.normals.resize(kVertices);
  for (std::uint32_t v = 0; v + 2 < kVertices; ++v) skin.triangles.push_back({v, v + 1, v + 2});
  Rig::Shape& lashes = rig.parts[std::size_t(Part::lashes)];
  lashes = {{{1, 2, 3}, {-1, 2, 3}, {0, 1, 2}}, std::vector<Vec3>(3), {{0, 1, 2}}};
  rig.lash_anchors = {4, 5, 6};
  rig.deforms[std::size_t(Part::skin)] = rig.deforms[std::size_t(Part::lashes)] = true;
  for (const int fap : {3, 5, 19, 53}) rig.targets.push_back(target_of(fap, dice));
  rig.targets.back().low = -100;
  rig.targets.back().high = 250;
  rig.fapu = {1, 6.3, 4, 3, 5};
  rig.eyes = {{{{3, 0, 1}, 1.2f, 0.6f, 0.2f}, {{-3, 0, 1}, 1.2f, 0.6f, 0.2f}}};
  rig.jaw_axis = {0, -2, -3};
  rig.neck_pivot = {0, -6, -2};
  rig.chin = {0, -9, 4};
  rig.lips = {{1, 2}, {3, 4}};
  rig.lids[1] = {{7, 8}};
  rig.lid_vertices[0] = {9, 11};
  rig.eye_skin[1] = {10, 2};  // in any order
  rig.rooms = {100, 200, 300, 400, 500, 600, 700, 800};
  rig.reaches = {{3, -200, 900}};
  rig.usual.fill(700);
  for (std::uint32_t t = 0; t < skin.triangles.size(); t += 5) {
    const auto& [a, b, c] = skin.triangles[t];
    const Vec3 at = skin.positions[a];
    rig.outside.push_back(
        {skin.triangles[t], cross(skin.positions[b] - at, skin.positions[c] - at), t % 2 == 0});
  }
  rig.teeth[0] = {{0, -4, 3}, 2, 3, 0.5f, {12, 13, 20}};
  rig.lid_follow = {0.1f, 0.2f};
  return rig;
}

// The same skin, moved by shapes.
Rig shape_rig() {
  Dice dice;
  Rig rig = small_rig();
  rig.targets.clear();
  rig.reaches.clear();
  rig.outside.clear();
  rig.mouth_gain = 1.2;
  for (const auto& [fap, value] : {std::pair(3, 600), std::pair(12, -300)}) {
    head::ShapeControl shape;
    shape.faps.set(fap, value);
    shape.faps.set(5, -value);
    if (fap == 3) shape.arkit = 0;
    if (fap == 12) shape.viseme = 10;
    rig.targets.push_back(target_of(head::kFirstShape + int(rig.shapes.size()), dice));
    rig.shapes.push_back(shape);
    rig.lip_measures.closing.push_back({1, 2, 3});
  }
  rig.lip_measures.at_rest = {4, 5, 6};
  rig.shown_by_shapes[std::size_t(Part::lower_teeth)] = true;
  return rig;
}

fap::Frame frame_of(unsigned seed) {
  std::mt19937 random(seed);
  fap::Frame frame;
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    if (random() % 3 > 0) frame.set(f, int(random() % 1200) - 600);
  }
  if (seed % 2 == 0) {
    frame = {};
    frame.mask.set(1);
    frame.viseme = {int(seed) % 15, 10, 40, false};
  }
  return frame;
}

// The largest distance of two rigs in some frames, cm.
float apart(const Rig& a, const Rig& b) {
  float most = 0;
  for (unsigned seed = 1; seed < 9; ++seed) {
    const head::Pose x = head::pose(a, frame_of(seed));
    const head::Pose y = head::pose(b, frame_of(seed));
    for (std::size_t part = 0; part < x.positions.size(); ++part) {
      EXPECT_EQ(x.positions[part].size(), y.positions[part].size());
      EXPECT_EQ(x.normals[part].size(), y.normals[part].size());
      for (std::size_t v = 0; v < x.positions[part].size(); ++v) {
        const Vec3 here = x.transforms[part](x.positions[part][v]);
        most = std::max(most, length(here - y.transforms[part](y.positions[part][v])));
      }
    }
  }
  return most;
}

TEST(PackedRig, MovesAsBefore) {
  for (const Rig& rig : {small_rig(), shape_rig()}) {
    const std::optional<Rig> back = unpack_rig(pack_rig(rig));
    ASSERT_TRUE(back);
    EXPECT_LT(apart(rig, *back), 0.005f);
    EXPECT_EQ(back->targets.size(), rig.targets.size());
    EXPECT_EQ(back->shapes.size(), rig.shapes.size());
    EXPECT_EQ(back->outside.size(), rig.outside.size());
    for (std::size_t i = 0; i < rig.outside.size(); ++i) {
      EXPECT_EQ(back->outside[i].corners, rig.outside[i].corners);
      EXPECT_EQ(back->outside[i].rolls, rig.outside[i].rolls);
      EXPECT_LT(length(back->outside[i].normal - rig.outside[i].normal), 0.01f);
    }
  }
  EXPECT_GT(apart(small_rig(), shape_rig()), 0.01f);
}

TEST(PackedRig, WhatIsCutOffIsNoRig) {
  const std::vector<std::uint8_t> bytes = pack_rig(shape_rig());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(unpack_rig(std::span(bytes).first(size))) << size;
  }
  std::vector<std::uint8_t> more = bytes;
  more.push_back(0);
  EXPECT_FALSE(unpack_rig(more));
}

// Where damage leaves a rig, it can be moved: its numbers alone are others.
TEST(PackedRig, DamageIsFoundOrDoesNotHurt) {
  std::mt19937 random(3);
  int found = 0, moved = 0;
  for (const Rig& rig : {small_rig(), shape_rig()}) {
    const std::vector<std::uint8_t> bytes = pack_rig(rig);
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      std::vector<std::uint8_t> broken = bytes;
      broken[at] = std::uint8_t(random());
      const std::optional<Rig> back = unpack_rig(broken);
      if (!back) {
        ++found;
      } else {
        ++moved;
        EXPECT_EQ(head::pose(*back, frame_of(5)).transforms.size(), std::size_t(head::kPartCount));
      }
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(moved, 100);
}

TEST(PackedRig, OursMoveAsBefore) {
  const head::Head head = *head::make_head();
  const Rig rig = head::make_rig(head);
  const std::vector<std::uint8_t> bytes = pack_rig(rig);
  EXPECT_LT(bytes.size(), 2'000'000u);
  const std::optional<Rig> back = unpack_rig(bytes);
  ASSERT_TRUE(back);
  EXPECT_LT(apart(rig, *back), 0.01f);
  EXPECT_GT(back->outside.size(), 1000u);
}

}  // namespace packed_rig_test
}  // namespace animeme::test
