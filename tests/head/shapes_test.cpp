// Visemes and expressions, closed lips, and what real captures do to the mesh.
#include "fap/head/shapes.h"

#include "fap/fill.h"
#include "fap/text.h"
#include "tests/head/head_support.h"
#include "tests/support/files.h"
#include "tests/support/shared.h"

namespace animeme::test {
namespace shapes_test {

using head::Part;
using head::Pose;
using head::Vec3;

const std::vector<Vec3>& skin(const Pose& pose) { return pose.positions[std::size_t(Part::skin)]; }

fap::Frame viseme(int first, int second, int blend) {
  fap::Frame frame;
  frame.mask.set(1);
  frame.viseme = {first, second, blend, false};
  return frame;
}

float widest_gap(const head::Rig& rig, const Pose& pose) {
  float gap = 0;
  for (const head::ContactPair& pair : rig.lips) {
    gap = std::max(gap, length(skin(pose)[pair.upper] - skin(pose)[pair.lower]));
  }
  return gap;
}

TEST(Shapes, BlendAsTheStandardSays) {
  const fap::Frame a = head::viseme_shape(10);
  const fap::Frame open = head::low_level(viseme(10, 0, 63));
  EXPECT_EQ(open.value, a.value);
  EXPECT_EQ(head::low_level(viseme(0, 10, 0)).value, a.value);
  EXPECT_NEAR(head::low_level(viseme(10, 0, 21)).value[3], a.value[3] / 3.0, 1);
  fap::Frame both;
  both.mask.set(2);
  both.expression.select1 = 1;
  both.expression.intensity1 = 63;
  both.expression.select2 = 6;
  both.expression.intensity2 = 21;
  EXPECT_NEAR(head::low_level(both).value[3],
              head::expression_shape(1).value[3] + head::expression_shape(6).value[3] / 3.0, 1);
}

TEST(Shapes, LowLevelFapsOfTheFrameWin) {
  fap::Frame frame = viseme(10, 0, 63);
  frame.set(3, 7);
  frame.set(48, 100);
  const fap::Frame low = head::low_level(frame);
  EXPECT_EQ(low.value[3], 7);
  EXPECT_EQ(low.value[48], 100);
  EXPECT_EQ(low.value[5], head::viseme_shape(10).value[5]);
  EXPECT_FALSE(low.mask[1]);
}

TEST(Shapes, AreThereAndSymmetric) {
  for (int v = 1; v <= 14; ++v) EXPECT_TRUE(head::viseme_shape(v).mask.any()) << v;
  for (int e = 1; e <= 6; ++e) EXPECT_TRUE(head::expression_shape(e).mask.any()) << e;
  EXPECT_TRUE(head::viseme_shape(0).mask.none());
  EXPECT_TRUE(head::viseme_shape(15).mask.none());
  EXPECT_TRUE(head::viseme_shape(-1).mask.none());
  EXPECT_TRUE(head::expression_shape(7).mask.none());
  for (int v = 0; v <= 14; ++v) {
    const fap::Frame shape = head::viseme_shape(v);
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const int mirror = fap::info(fap).mirror;
      if (mirror == 0) continue;
      EXPECT_EQ(shape.value[std::size_t(fap)], shape.value[std::size_t(mirror)]);
    }
  }
}

class EachMouth : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Heads, EachMouth, ::testing::Values("woman", "man", "child"));

TEST_P(EachMouth, LipsMeetAtPAndOpenAtA) {
  const head::Rig& rig = rig_of(GetParam());
  EXPECT_LT(widest_gap(rig, head::pose(rig, viseme(1, 0, 63))), 5e-3f);
  EXPECT_GT(widest_gap(rig, head::pose(rig, viseme(10, 0, 63))), 1.0f);
  for (const int closed : {3, 5}) {  // anger presses lips; FAP 5 alone pushes into the upper lip
    fap::Frame frame;
    if (closed == 3) {
      frame.mask.set(2);
      frame.expression.select1 = 3;
      frame.expression.intensity1 = 63;
    } else {
      frame.set(5, 500);
      frame.set(10, 400);
      frame.set(11, 400);
    }
    EXPECT_LT(widest_gap(rig, head::pose(rig, frame)), 5e-3f) << closed;
  }
}

TEST_P(EachMouth, LipsNeverPassEachOther) {
  const head::Rig& rig = rig_of(GetParam());
  for (int v = 0; v <= 14; ++v) {
    for (const int w : {1, 6, 10, 14}) {
      const Pose pose = head::pose(rig, viseme(v, w, 32));
      for (const head::ContactPair& pair : rig.lips) {
        EXPECT_GE(skin(pose)[pair.upper].y, skin(pose)[pair.lower].y - 1e-4f) << v << " " << w;
      }
    }
  }
}

TEST_P(EachMouth, ShapesInvertNoTriangles) {
  const head::Rig& rig = rig_of(GetParam());
  const auto& triangles = rig.parts[0].triangles;
  for (int v = 1; v <= 14; ++v) {
    const Pose pose = head::pose(rig, viseme(v, 0, 63));
    EXPECT_LE(inverted_triangles(skin(pose), pose.normals[0], triangles),
              int(triangles.size() / 500))
        << v;
  }
}

// Every 10th frame of real captures: all is finite, and next to no triangle turns over.
TEST(Captures, KeepTheFaceWhole) {
  const std::filesystem::path folder = shared_dir() / "wild_fap";
  if (shared_dir().empty() || !std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "no reference data: set ANIMEME_SHARED";
  }
  const head::Rig& rig = rig_of("woman");
  const auto& triangles = rig.parts[0].triangles;
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".fap") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  int shown = 0;
  for (const auto& path : paths) {
    const auto clip = fap::read_text(test::slurp(path));
    if (!clip) continue;
    const auto filled = fap::fill(*clip);
    ASSERT_TRUE(filled) << path;
    for (std::size_t i = 0; i < filled->frames.size(); i += 10) {
      const Pose pose = head::pose(rig, filled->frames[i]);
      for (const Vec3& p : skin(pose)) ASSERT_TRUE(std::isfinite(dot(p, p))) << path << " " << i;
      EXPECT_LE(inverted_triangles(skin(pose), pose.normals[0], triangles),
                int(triangles.size() / 200))
          << path << " frame " << i;
      ++shown;
    }
  }
  EXPECT_GT(shown, 50);
}

void expect_finite(const Pose& pose) {
  for (const auto* vertices : {&pose.positions, &pose.normals}) {
    for (const auto& part : *vertices) {
      for (const Vec3& p : part) ASSERT_TRUE(std::isfinite(dot(p, p)));
    }
  }
}

// Far beyond any face: nothing but numbers comes out.
TEST(Extremes, StayFinite) {
  for (const int value : {-2000000000, -100000, 100000, 2000000000}) {
    fap::Frame frame;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) frame.set(fap, value);
    expect_finite(head::pose(rig_of("child"), frame));
  }
}

TEST(Extremes, ReferenceStreamsStayFinite) {
  const std::filesystem::path folder = shared_dir() / "conformance" / "streams";
  if (shared_dir().empty() || !std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "no reference data: set ANIMEME_SHARED";
  }
  int shown = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!entry.path().string().ends_with(".dec.fap")) continue;
    const auto clip = fap::read_text(test::slurp(entry.path()));
    ASSERT_TRUE(clip) << entry.path();
    for (std::size_t i = 0; i < clip->frames.size(); i += 20) {
      expect_finite(head::pose(rig_of("child"), clip->frames[i]));
      ++shown;
    }
  }
  EXPECT_GT(shown, 20);
}

}  // namespace shapes_test
}  // namespace animeme::test
