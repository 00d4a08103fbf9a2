// FAPs move their feature points, and the rest of the face with them.
#include <cmath>

#include "fap/head/shapes.h"
#include "tests/head/head_support.h"

namespace animeme::test {
namespace rig_test {

using head::Head;
using head::Part;
using head::Pose;
using head::Rig;
using head::Vec3;

class EachRig : public ::testing::TestWithParam<std::string> {
 protected:
  const Head& head() const { return head_of(GetParam()); }
  const Rig& rig() const { return rig_of(GetParam()); }
  Pose posed_at(int fap, int value, bool contact = false) const {
    fap::Frame frame;
    frame.set(fap, value);
    return head::pose(rig(), frame, {.contact = contact});
  }
  Vec3 moved(const Pose& pose, std::string_view id) const {
    return posed(head(), rig(), pose, id) - head().at(id);
  }
  const std::vector<Vec3>& skin(const Pose& pose) const {
    return pose.positions[std::size_t(Part::skin)];
  }
};
INSTANTIATE_TEST_SUITE_P(Heads, EachRig, ::testing::Values("woman", "man", "child"));

// The table of the standard: each FAP moves its point by value * FAPU/1024 along its axis.
TEST_P(EachRig, EachFapMovesItsPointAsFarAsTheTableSays) {
  EXPECT_GT(expect_table_moves(head(), rig(), {512, -300}), 100);
}

// A point that has a FAP of its own does not go along with those of others.
TEST_P(EachRig, FapsOfOtherPointsOfTheLipsLeaveAPointAlone) {
  const int lips[] = {4, 5, 8, 9, 10, 11, 12, 13, 51, 52, 55, 56, 57, 58, 59, 60};
  for (const int fap : lips) {
    const Pose pose = posed_at(fap, 500);
    for (const int other : lips) {
      const std::string_view id = fap::info(other).feature_point;
      if (id == fap::info(fap).feature_point) continue;
      EXPECT_LT(length(moved(pose, id)), 0.02 * std::abs(fap::displacement(fap, 500, rig().fapu)))
          << "FAP " << fap << " on " << id;
    }
  }
}

TEST_P(EachRig, NeutralFrameIsTheNeutralFace) {
  const Pose pose = head::pose(rig(), fap::Frame{});
  EXPECT_EQ(skin(pose), head().part(Part::skin).positions);
  for (const head::Transform& t : pose.transforms) EXPECT_EQ(t, head::Transform{});
}

TEST_P(EachRig, LeftAndRightFapsAreMirrorImages) {
  const auto& places = head().part(Part::skin).positions;
  for (const int fap : {6, 8, 12, 19, 21, 31, 33, 35, 37, 39, 41, 53, 61, 65, 67}) {
    const Pose left = posed_at(fap, 300);
    const Pose right = posed_at(fap::info(fap).mirror, 300);
    double of_left = 0;
    double of_right = 0;
    double sideways = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
      of_left += length(skin(left)[v] - places[v]);
      of_right += length(skin(right)[v] - places[v]);
      sideways += (skin(left)[v] - places[v]).x + (skin(right)[v] - places[v]).x;
    }
    EXPECT_GT(of_left, 0) << fap;
    EXPECT_NEAR(of_left, of_right, 2e-3 * of_left) << fap;
    EXPECT_NEAR(sideways, 0, 2e-3 * of_left) << fap;
  }
}

TEST_P(EachRig, JawTakesTeethAndTongueAlong) {
  const Pose pose = posed_at(3, 800);
  const double drop = fap::displacement(3, 800, rig().fapu);
  EXPECT_LT(moved(pose, "9.11").y, -0.4 * drop);
  EXPECT_LT(moved(pose, "9.11").z, 0);  // on an arc
  EXPECT_LT(moved(pose, "2.1").z, -0.2 * drop);
  EXPECT_LT(moved(pose, "6.1").y, -0.3 * drop);
  EXPECT_EQ(length(moved(pose, "9.10")), 0);
  EXPECT_LT(length(moved(pose, "2.3")), 0.02 * drop);  // lips have FAPs of their own
}

// Heads of others: nobody knows which vertices of the lips touch each other.
TEST_P(EachRig, LipsOfHeadsWithoutSeamsMeetWhereTheyNearlyDo) {
  Head bare = head();
  bare.seams.lips.clear();
  const Rig rig = head::make_rig(bare);
  const auto apart = [&](int upper, int lower, bool contact = true) {
    fap::Frame frame;
    for (const int fap : {4, 8, 9}) frame.set(fap, upper);
    for (const int fap : {5, 10, 11}) frame.set(fap, lower);
    const Pose pose = head::pose(rig, frame, {.contact = contact});
    float most = 0;
    for (const auto& [u, l] : {std::pair("2.2", "2.3"), {"2.6", "2.8"}, {"2.7", "2.9"}}) {
      most = std::max(most, std::abs(posed(bare, rig, pose, u).y - posed(bare, rig, pose, l).y));
    }
    return most;
  };
  EXPECT_LT(apart(60, -70), 1e-3f);
  EXPECT_LT(apart(-10, -10), 1e-3f);
  EXPECT_LT(apart(150, 150), 1e-3f);  // they would pass each other
  EXPECT_GT(apart(60, -70, false), 0.01f);
  const float unit = float(fap::displacement(4, 1, rig.fapu));
  EXPECT_NEAR(apart(-100, -100), 200 * unit, 6 * unit);
}

TEST_P(EachRig, ClosedLidsMeetAndCoverTheEye) {
  for (const auto& [upper, lower] : {std::pair(1024, 0), {700, 324}, {1080, 600}, {0, 1024}}) {
    fap::Frame frame;
    for (const int fap : {19, 20}) frame.set(fap, upper);
    for (const int fap : {21, 22}) frame.set(fap, lower);
    const Pose pose = head::pose(rig(), frame);
    for (std::size_t side = 0; side < 2; ++side) {
      ASSERT_FALSE(rig().lids[side].empty());
      for (const head::ContactPair& pair : rig().lids[side]) {
        EXPECT_LT(length(skin(pose)[pair.upper] - skin(pose)[pair.lower]), 2e-3f);
      }
      // Lids slide: they do not go into the ball.
      for (const std::uint32_t v : rig().lid_vertices[side]) {
        EXPECT_GT(length(skin(pose)[v] - rig().eyes[side].centre), rig().eyes[side].radius);
      }
    }
  }
}

TEST_P(EachRig, HeadTurnsAboutTheNeck) {
  fap::Frame frame;
  frame.set(48, 20000);  // 0.2 rad down
  const Pose pose = head::pose(rig(), frame);
  const Vec3 nose = head().at("9.3") - head().neck_pivot;
  const Vec3 turned = posed(head(), rig(), pose, "9.3") - head().neck_pivot;
  EXPECT_NEAR(length(turned), length(nose), 1e-3);
  EXPECT_NEAR(std::atan2(turned.y, turned.z) - std::atan2(nose.y, nose.z), -0.2, 1e-4);
  frame = {};
  frame.set(49, 20000);
  EXPECT_GT(posed(head(), rig(), head::pose(rig(), frame), "9.3").x, 1);  // to the left
  frame = {};
  frame.set(50, 20000);
  EXPECT_LT(posed(head(), rig(), head::pose(rig(), frame), "11.4").x, -1);  // to the right
  // Shoulders stay, and so does the end of the neck.
  EXPECT_EQ(pose.transforms[std::size_t(Part::body)], head::Transform{});
  float lowest = 0;
  std::size_t bottom = 0;
  for (std::size_t v = 0; v < skin(pose).size(); ++v) {
    if (head().part(Part::skin).positions[v].y >= lowest) continue;
    lowest = head().part(Part::skin).positions[v].y;
    bottom = v;
  }
  EXPECT_EQ(skin(pose)[bottom], head().part(Part::skin).positions[bottom]);
}

TEST_P(EachRig, EyesTurnAndPupilsGrow) {
  const Pose left = posed_at(23, 20000);
  EXPECT_NEAR(moved(left, "3.5").x, head().eyes[0].radius * std::sin(0.2), 1e-3);
  EXPECT_EQ(length(moved(left, "3.6")), 0);
  EXPECT_LT(moved(posed_at(26, 20000), "3.6").y, -0.1);
  EXPECT_NEAR(moved(posed_at(27, 200), "3.5").z, fap::displacement(27, 200, rig().fapu), 1e-4);
  const Pose wide = posed_at(29, 200);
  const auto part = std::size_t(Part::left_eye);
  const float centre = head().eyes[0].centre.x;
  float was = 0;
  float is = 0;
  for (std::size_t v = 0; v < rig().parts[part].positions.size(); ++v) {
    const Vec3 p = rig().parts[part].positions[v];
    if (std::hypot(p.x - centre, p.y) > head().eyes[0].pupil_radius || p.z < 0) continue;
    was = std::max(was, p.x - centre);
    is = std::max(is, wide.positions[part][v].x - centre);
  }
  EXPECT_NEAR(is - was, 0.5 * fap::displacement(29, 200, rig().fapu), 0.1 * (is - was));
}

// The rim of the upper lid moves as far as 0.65 of the pitch takes it over the eyeball.
TEST_P(EachRig, UpperLidsFollowTheGazeIfTheFrameDoesNotCarryThem) {
  fap::Frame frame;
  frame.set(25, 30000);
  const double wanted = -0.65 * 0.3 * head().eyes[0].radius;
  const Pose down = head::pose(rig(), frame);
  EXPECT_NEAR(moved(down, "3.1").y, wanted, 0.03 * std::abs(wanted));
  EXPECT_EQ(length(moved(down, "3.2")), 0);
  EXPECT_EQ(length(moved(head::pose(rig(), frame, {.follow = false}), "3.1")), 0);
  frame.set(25, -10000);
  EXPECT_GT(moved(head::pose(rig(), frame), "3.1").y, 0.1f);
  frame.set(19, 0);  // it says that the lid rests
  EXPECT_EQ(length(moved(head::pose(rig(), frame), "3.1")), 0);
  frame.set(19, 200);
  frame.set(25, 30000);
  EXPECT_NEAR(moved(head::pose(rig(), frame), "3.1").y, -fap::displacement(19, 200, rig().fapu),
              0.01);
}

TEST_P(EachRig, TongueRollsToAU) {
  const Pose pose = posed_at(47, 30000);
  EXPECT_GT(moved(pose, "6.3").y, 0.02);
  EXPECT_NEAR(moved(pose, "6.3").y, moved(pose, "6.4").y, 1e-4);
  EXPECT_LT(moved(pose, "6.2").y, 0.01);
}

TEST_P(EachRig, BrowsLieOnTheirSkin) {
  fap::Frame frame;
  for (const int fap : {31, 32, 33, 34, 35, 36}) frame.set(fap, 400);
  const Pose pose = head::pose(rig(), frame);
  const auto brows = std::size_t(Part::brows);
  const double lift = fap::displacement(33, 400, rig().fapu);
  double mean = 0;
  for (std::size_t v = 0; v < rig().parts[brows].positions.size(); ++v) {
    mean += pose.positions[brows][v].y - rig().parts[brows].positions[v].y;
  }
  mean /= double(rig().parts[brows].positions.size());
  EXPECT_NEAR(mean, lift, 0.15 * lift);
}

// A mesh with nothing but some feature points is a head, too.
TEST(MakeRig, TakesAHeadThatLacksMost) {
  Head bare;
  bare.part(Part::skin) = head_of("woman").part(Part::skin);
  bare.fapu = head_of("woman").fapu;
  for (std::size_t i = 0; i < fap::kFeaturePoints.size(); ++i) {
    const std::string_view id = fap::kFeaturePoints[i].id;
    if (id == "2.1" || id == "2.2" || id == "2.3" || id == "3.1" || id == "4.1") {
      bare.feature_points[i] = head_of("woman").feature_points[i];
    }
  }
  const Rig rig = head::make_rig(bare);
  for (const int fap : {3, 4, 5, 19, 31}) {
    fap::Frame frame;
    frame.set(fap, -200);
    const Pose pose = head::pose(rig, frame, {.contact = false});
    const std::string id(fap::info(fap).feature_point);
    const float moved = posed(bare, rig, pose, id).y - bare.at(id).y;
    const double wanted = fap::displacement(fap, -200, rig.fapu) * fap::move_of(fap).axis[1];
    EXPECT_NEAR(moved, wanted, 0.03 * std::abs(wanted)) << fap;
  }
  fap::Frame all;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) all.set(fap, 100);
  EXPECT_EQ(head::pose(rig, all).positions[0].size(), bare.part(Part::skin).positions.size());
  EXPECT_EQ(head::pose(head::make_rig(Head{}), all).positions[0].size(), 0u);
}

}  // namespace rig_test
}  // namespace animeme::test
