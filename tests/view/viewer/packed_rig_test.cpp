// Rigs as bytes: what comes back moves as before, and damage is found before it is used.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/view/viewer/rigs.h"
#include "tools/view/viewer/rig/packed_rig.h"

namespace animeme::test {
namespace packed_rig_test {

using head::Rig;
using head::Vec3;
using viewer::detail::pack_rig;
using viewer::detail::unpack_rig;

// The largest distance of two rigs in some frames, cm.
float apart(const Rig& a, const Rig& b) {
  float most = 0;
  for (unsigned seed = 1; seed < 9; ++seed) {
    const head::Pose x = head::pose(a, random_frame(seed));
    const head::Pose y = head::pose(b, random_frame(seed));
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
        EXPECT_EQ(head::pose(*back, random_frame(5)).transforms.size(),
                  std::size_t(head::kPartCount));
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
  EXPECT_GT(back->outside.size(), 1000u);
  // Where skin is about to fold over, rounding decides at which step the search stops.
  EXPECT_LT(apart(rig, *back), 0.3f);
  head::Rig free = rig, free_back = *back;
  free.outside.clear();
  free_back.outside.clear();
  EXPECT_LT(apart(free, free_back), 0.01f);
}

}  // namespace packed_rig_test
}  // namespace animeme::test
