// The tongue is a body, and stays out of teeth, palate and lips.
#include "fap/head/shapes.h"
#include "tests/head/head_support.h"

namespace animeme::test {
namespace tongue_test {

using head::Part;
using head::Vec3;

class EachTongue : public ::testing::TestWithParam<std::string> {
 protected:
  const head::Head& head() const { return head_of(GetParam()); }
  const head::Rig& rig() const { return rig_of(GetParam()); }

  std::vector<Vec3> posed_part(Part part) const {
    const auto i = std::size_t(part);
    std::vector<Vec3> places =
        pose_.positions[i].empty() ? rig().parts[i].positions : pose_.positions[i];
    for (Vec3& p : places) p = pose_.transforms[i](p);
    return places;
  }

  // How often the surface is around a place: 0 outside.
  static int times_around(Vec3 place, const std::vector<Vec3>& places,
                          const std::vector<head::Triangle>& triangles) {
    place.x += 1e-4f;  // not between left and right, where edges are
    int times = 0;
    for (const head::Triangle& t : triangles) {
      const Vec3 a = places[t[0]] - place, b = places[t[1]] - place, c = places[t[2]] - place;
      if (std::max({a.z, b.z, c.z}) < 0) continue;
      const float of_c = a.x * b.y - a.y * b.x;
      const float of_a = b.x * c.y - b.y * c.x;
      const float of_b = c.x * a.y - c.y * a.x;
      const bool front = of_a >= 0 && of_b >= 0 && of_c >= 0;
      const bool back = of_a < 0 && of_b < 0 && of_c < 0;
      const float sum = of_a + of_b + of_c;
      if (!(front || back) || sum == 0) continue;
      if ((a.z * of_a + b.z * of_b + c.z * of_c) / sum > 0) times += front ? 1 : -1;
    }
    return times;
  }

  // The part before the root, which grows out of the floor of the mouth: how many of its vertices
  // are in a part, even if they give way by `soft` cm upwards.
  int within(Part part, float soft = 0) const {
    const std::vector<Vec3> tongue = posed_part(Part::tongue);
    const std::vector<Vec3> places = posed_part(part);
    const auto& rest = rig().parts[std::size_t(Part::tongue)].positions;
    const float root = 0.6f * head().at("6.2").z + 0.4f * head().at("6.1").z;
    int count = 0;
    for (std::size_t v = 0; v < tongue.size(); ++v) {
      if (rest[v].z < root) continue;
      const auto& triangles = rig().parts[std::size_t(part)].triangles;
      count += times_around(tongue[v] + Vec3{0, soft, 0}, places, triangles) > 0 ? 1 : 0;
    }
    return count;
  }

  void show(const fap::Frame& frame) { head::pose(rig(), frame, pose_); }

  head::Pose pose_;
};
INSTANTIATE_TEST_SUITE_P(Heads, EachTongue, ::testing::Values("woman", "man", "child"));

TEST_P(EachTongue, IsThickWithARoundTipAndAGroove) {
  const auto& places = rig().parts[std::size_t(Part::tongue)].positions;
  const Vec3 tip = head().at("6.1");
  // Height and width of what is near a place behind the tip.
  const auto extent = [&](float behind) {
    Vec3 low{9, 99, 0}, high{-9, -99, 0};
    for (const Vec3& p : places) {
      if (std::abs(tip.z - behind - p.z) > 0.15f) continue;
      low = {std::min(low.x, p.x), std::min(low.y, p.y), 0};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
    }
    return high - low;
  };
  const auto wide = float(rig().fapu.mw);
  EXPECT_GT(extent(2).y, 0.19f * wide);
  EXPECT_GT(extent(1).y, 0.13f * wide);
  EXPECT_GT(extent(0.4f).y, 0.06f * wide);
  EXPECT_GT(extent(0.4f).x, 0.19f * wide);
  EXPECT_LT(extent(0.4f).x, 0.95f * extent(1.5f).x);
  // 6.2 lies in the groove: the back is higher beside it.
  const Vec3 groove = head().at("6.2");
  float beside = groove.y;
  for (const Vec3& p : places) {
    if (std::abs(p.z - groove.z) < 0.05f) beside = std::max(beside, p.y);
  }
  EXPECT_GT(beside, groove.y + 0.01f * wide);
}

TEST_P(EachTongue, LiesInTheMouthAtRestAndInSpeech) {
  constexpr float kSoft = 0.06f;  // teeth press on it in TH
  for (int viseme = 0; viseme <= 14; ++viseme) {
    show(head::viseme_shape(viseme));
    EXPECT_EQ(within(Part::skin), 0) << "viseme " << viseme;
    EXPECT_EQ(within(Part::lower_teeth, kSoft), 0) << "viseme " << viseme;
    EXPECT_EQ(within(Part::upper_teeth, -kSoft), 0) << "viseme " << viseme;
  }
}

TEST_P(EachTongue, StaysBehindShutLips) {
  for (const int fap : {43, 44, 45, 46, 47}) {
    for (const int way : {-1, 1}) {
      fap::Frame frame;
      frame.set(fap, way * fap::info(fap).quant_step * fap::info(fap).default_i_range);
      show(frame);
      const float lips = head().at("2.3").z;
      for (const Vec3& p : posed_part(Part::tongue)) ASSERT_LT(p.z, lips) << fap << ' ' << way;
    }
  }
}

// TH shows the tip between the teeth, L and N behind the upper ones.
TEST_P(EachTongue, ShowsItsTipInSpeech) {
  const auto at = [&](const char* id) { return posed(head(), rig(), pose_, id); };
  show(head::viseme_shape(3));
  EXPECT_GT(at("6.1").z, at("9.10").z);
  EXPECT_LT(at("6.1").y, at("9.10").y + 0.1f);
  EXPECT_GT(at("6.1").y, at("9.11").y);
  for (const int viseme : {4, 8}) {
    show(head::viseme_shape(viseme));
    EXPECT_GT(at("6.1").y, at("9.10").y) << viseme;
    EXPECT_LT(at("6.1").z, at("9.10").z) << viseme;
  }
}

TEST_P(EachTongue, ComesOutOfAnOpenMouth) {
  fap::Frame frame;
  for (const auto& [fap, value] : {std::pair(3, 500), {5, -600}, {10, -600}, {11, -600}, {45, 600}})
    frame.set(fap, value);
  show(frame);
  EXPECT_GT(posed(head(), rig(), pose_, "6.1").z, head().at("2.3").z + 0.8f);
}

}  // namespace tongue_test
}  // namespace animeme::test
