// People to choose from, and how round their mouths are.
#include "fap/head/people.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fap/head/rig.h"
#include "fap/head/shapes.h"
#include "tests/head/head_support.h"

namespace {

using namespace animeme;
using head::HairStyle;
using head::Part;
using head::Vec3;
using ::testing::HasSubstr;

TEST(People, EachHasAWholeHead) {
  for (const std::string_view name : head::kPeople) {
    const auto parameters = head::parse_head(name);
    ASSERT_TRUE(parameters) << name;
    const auto made = head::make_head(*parameters);
    ASSERT_TRUE(made) << name << ": " << made.error().message;
    EXPECT_EQ(made->name, name);
    for (std::size_t i = 0; i < made->feature_points.size(); ++i) {
      if (fap::kFeaturePoints[i].id == "7.1") continue;
      const head::FeaturePoint point = made->feature_points[i];
      ASSERT_TRUE(point.exists()) << name << " " << fap::kFeaturePoints[i].id;
      EXPECT_LT(point.vertex, made->part(point.part).positions.size()) << name;
    }
    for (const head::Mesh& mesh : made->parts) {
      EXPECT_EQ(mesh.colours.size(), mesh.positions.size()) << name;
      EXPECT_EQ(mesh.occlusion.size(), mesh.positions.size()) << name;
      for (const Vec3& p : mesh.positions) {
        ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << name;
      }
    }
    EXPECT_GT(made->fapu.mw, 0) << name;
  }
}

TEST(People, WordsChangeThem) {
  const auto plain = head::parse_head("woman");
  const auto changed =
      head::parse_head("woman:skin=6:hair=black-curly:eyes=blue:glasses=square:clothes=#102030");
  ASSERT_TRUE(plain);
  ASSERT_TRUE(changed);
  EXPECT_EQ(plain->hair, HairStyle::bob);
  EXPECT_EQ(changed->hair, HairStyle::curly);
  EXPECT_EQ(changed->glasses, head::Glasses::square);
  EXPECT_EQ(changed->cloth_colour, 0x102030u);
  EXPECT_NE(changed->skin_colour, plain->skin_colour);
  EXPECT_NE(changed->iris_colour, plain->iris_colour);
  // The later word wins, and a colour leaves the form as it is.
  EXPECT_EQ(head::parse_head("woman:hair=long:hair=red")->hair, HairStyle::lengthy);
  EXPECT_EQ(head::parse_head("kenji:glasses=none")->glasses, head::Glasses::none);
  EXPECT_EQ(head::parse_head("man:beard")->beard, head::Beard::full);
  EXPECT_EQ(head::parse_head("woman:hair=#123456")->hair_colour, 0x123456u);
}

TEST(People, GrowAndAge) {
  const auto at = [](int years) { return *head::parse_head("woman:age=" + std::to_string(years)); };
  EXPECT_LT(at(8).chin_drop, at(14).chin_drop);
  EXPECT_LT(at(14).chin_drop, at(25).chin_drop);
  EXPECT_EQ(at(25).lines, 0);
  EXPECT_LT(at(45).lines, at(65).lines);
  EXPECT_NE(at(70).hair_colour, at(30).hair_colour);
  // A colour that is asked for does not turn grey.
  EXPECT_EQ(head::parse_head("woman:hair=red:age=80")->hair_colour,
            head::parse_head("woman:hair=red")->hair_colour);
}

TEST(People, WhatIsWrongIsNamed) {
  const auto problem = [](std::string_view text) {
    const auto parsed = head::parse_head(text);
    EXPECT_FALSE(parsed) << text;
    return parsed ? std::string() : parsed.error().message;
  };
  EXPECT_THAT(problem("dragon"), HasSubstr("amara"));
  EXPECT_THAT(problem("woman:skin=7"), HasSubstr("1 (very light) to 6"));
  EXPECT_THAT(problem("woman:skin="), HasSubstr("skin"));
  EXPECT_THAT(problem("woman:hair=purple"), HasSubstr("auburn"));
  EXPECT_THAT(problem("woman:hair=purple"), HasSubstr("curly"));
  EXPECT_THAT(problem("woman:hair"), HasSubstr("words are"));
  EXPECT_THAT(problem("woman:age=4"), HasSubstr("5 to 90"));
  EXPECT_THAT(problem("woman:age=12.5"), HasSubstr("5 to 90"));
  EXPECT_THAT(problem("woman:glasses=pink"), HasSubstr("round, square"));
  EXPECT_THAT(problem("woman:hat"), HasSubstr("\"hat\""));
  EXPECT_THAT(problem("woman:"), HasSubstr("words are"));
  EXPECT_TRUE(head::names_person("woman:anything"));
  EXPECT_FALSE(head::names_person("womanly"));
}

// Heights of the opening against an ellipse with the same width and height: root of the mean square
// of their difference, as a share of the height of the opening.
double ellipse_error(const head::Head& head, const head::Rig& rig, int viseme) {
  const head::Pose pose = head::pose(rig, head::viseme_shape(viseme));
  const std::vector<Vec3>& skin = pose.positions[std::size_t(Part::skin)];
  double left = 0, right = 0, most = 0;
  for (const head::ContactPair& pair : head.seams.lips) {
    left = std::max(left, double(skin[pair.upper].x));
    right = std::min(right, double(skin[pair.upper].x));
    most = std::max(most, double(skin[pair.upper].y - skin[pair.lower].y));
  }
  double sum = 0;
  for (const head::ContactPair& pair : head.seams.lips) {
    const double t = (2 * skin[pair.upper].x - left - right) / (left - right);
    const double opening = (skin[pair.upper].y - skin[pair.lower].y) / most;
    const double off = opening - std::sqrt(std::max(1 - t * t, 0.0));
    sum += off * off;
  }
  return std::sqrt(sum / double(head.seams.lips.size()));
}

// How far the middle of the lower lip, a quarter of its width, is from half an ellipse with the
// width and depth of the whole, at most, as a share of the depth: a point differs by more.
double lower_middle_error(const head::Head& head, const head::Rig& rig, int viseme) {
  const head::Pose pose = head::pose(rig, head::viseme_shape(viseme));
  const std::vector<Vec3>& skin = pose.positions[std::size_t(Part::skin)];
  const Vec3 corner = skin[head.point("2.4").vertex], middle = skin[head.point("2.3").vertex];
  double most = 0;
  for (const head::ContactPair& pair : head.seams.lips) {
    const Vec3 p = skin[pair.lower];
    const double t = std::abs(p.x) / corner.x;
    if (t > 0.25) continue;
    const double depth = (p.y - corner.y) / (middle.y - corner.y);
    most = std::max(most, std::abs(depth - std::sqrt(1 - t * t)));
  }
  return most;
}

TEST(People, LowerLipsHaveNoPoint) {
  for (const char* name : {"woman", "man", "child"}) {
    for (const int viseme : {10, 13, 14}) {
      EXPECT_LT(lower_middle_error(test::head_of(name), test::rig_of(name), viseme), 0.08)
          << name << " viseme " << viseme;
    }
  }
}

TEST(People, RoundMouthsAreRound) {
  for (const char* name : {"woman", "man", "child"}) {
    const head::Head& head = test::head_of(name);
    const head::Rig& rig = test::rig_of(name);
    for (const int viseme : {10, 13, 14}) {
      EXPECT_LT(ellipse_error(head, rig, viseme), 0.1) << name << " viseme " << viseme;
    }
  }
}

}  // namespace
