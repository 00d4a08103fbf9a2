// Brows that are a mesh upon the skin, and shapes that would hide them in it.
#include "tools/view/gltf/detail/brow_clearance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/support/folders.h"
#include "tools/view/gltf/detail/texture.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {
namespace brow_clearance_test {

using head::Vec3;

constexpr float kRadius = 10, kAbove = 0.12f, kEyes = 6;

// A forehead of this radius, and where it is over x and y.
float forehead(float x, float y) { return std::sqrt(kRadius * kRadius - x * x - y * y); }

// A sheet of rows and columns over a rectangle, `above` the forehead.
RawPiece sheet(const Paint& paint, float x0, float y0, float x1, float y1, int steps, float above) {
  RawPiece piece;
  piece.name = "Face";
  piece.paint = &paint;
  for (int j = 0; j <= steps; ++j) {
    for (int i = 0; i <= steps; ++i) {
      const float x = x0 + (x1 - x0) * float(i) / float(steps);
      const float y = y0 + (y1 - y0) * float(j) / float(steps);
      piece.positions.push_back({x, y, forehead(x, y) + above});
      if (i == steps || j == steps) continue;
      const auto at = std::uint32_t(j * (steps + 1) + i), up = at + std::uint32_t(steps) + 1;
      piece.triangles.push_back({at, at + 1, up + 1});
      piece.triangles.push_back({at, up + 1, up});
    }
  }
  return piece;
}

struct Forehead {
  Paint skin, hair;
  std::vector<RawPiece> pieces;
  std::vector<ChosenShape> shapes{2};
  std::vector<std::size_t> shape_of_name{0, 1};

  Forehead() {
    skin.name = "Face_SKIN";
    hair.name = "FaceBrow";
    pieces.push_back(sheet(skin, -6, -4, 6, 4, 40, 0));
    pieces.push_back(sheet(hair, 1, 0.4f, 4, 1, 6, kAbove));
  }
  // A shape that moves the brows by the same for each vertex.
  void move_brows(std::size_t shape, Vec3 by) {
    PieceMorph morph;
    morph.shape = shape;
    for (std::uint32_t v = 0; v < pieces[1].positions.size(); ++v) {
      morph.moves.vertices.push_back(v);
      morph.moves.deltas.push_back(by);
    }
    pieces[1].morphs.push_back(morph);
  }
  std::size_t keep() { return keep_brows_in_front(pieces, {pieces, shapes, shape_of_name}, kEyes); }
  // The least distance in front of the forehead with these weights of the shapes.
  float least(float first, float second = 0) const {
    std::vector<Vec3> shown = pieces[1].positions;
    const float weights[] = {first, second};
    for (const PieceMorph& morph : pieces[1].morphs) {
      for (std::size_t i = 0; i < morph.moves.vertices.size(); ++i)
        shown[morph.moves.vertices[i]] += morph.moves.deltas[i] * weights[morph.shape];
    }
    float least = 1;
    for (const head::Triangle& t : pieces[1].triangles) {
      for (const Vec3& p : {shown[t[0]], shown[t[1]], (shown[t[0]] + shown[t[1]]) * 0.5f,
                            (shown[t[0]] + shown[t[1]] + shown[t[2]]) * (1 / 3.0f)}) {
        least = std::min(least, p.z - forehead(p.x, p.y));
      }
    }
    return least;
  }
};

TEST(BrowClearance, BrowsComeOutOfTheSkin) {
  Forehead face;
  face.move_brows(0, {-0.5f, 0.1f, 0});  // to where the forehead is higher
  EXPECT_LT(face.least(1), -0.03f);
  EXPECT_EQ(face.keep(), 1u);
  for (const float weight : {0.25f, 0.5f, 1.0f, 1.5f})
    EXPECT_GT(face.least(weight), 0.03f) << weight;
}

TEST(BrowClearance, SumsOfShapesKeepClear) {
  Forehead face;
  face.move_brows(0, {-0.5f, 0.1f, 0});
  face.move_brows(1, {0.1f, 0.1f, -0.15f});
  EXPECT_EQ(face.keep(), 2u);
  EXPECT_GT(face.least(1, 1), 0.03f);
  EXPECT_GT(face.least(0.5f, 1), 0.03f);
}

// The skin may come up as well, and shapes that keep clear stay as they are.
TEST(BrowClearance, FollowsTheSkin) {
  Forehead face;
  face.move_brows(0, {0, -0.3f, 0.1f});
  const std::vector<Vec3> before = face.pieces[1].morphs[0].moves.deltas;
  EXPECT_EQ(face.keep(), 0u);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(face.pieces[1].morphs[0].moves.deltas[i].z, before[i].z, 0.001f);

  Forehead rising;
  rising.move_brows(0, {0, 0, 0.01f});
  PieceMorph skin;
  for (std::uint32_t v = 0; v < rising.pieces[0].positions.size(); ++v) {
    skin.moves.vertices.push_back(v);
    skin.moves.deltas.push_back({0, 0, 0.3f});
  }
  rising.pieces[0].morphs.push_back(skin);
  EXPECT_EQ(rising.keep(), 1u);
  EXPECT_GT(rising.least(1), 0.3f + 0.1f);
}

// Brows far from the skin, or in it at rest, are left alone, and so is what is no brow.
TEST(BrowClearance, LeavesOthersAlone) {
  for (const float above : {1.0f, -0.3f}) {
    Forehead face;
    for (Vec3& p : face.pieces[1].positions) p.z += above - kAbove;
    face.move_brows(0, {0, 0, -0.5f});
    EXPECT_EQ(face.keep(), 0u) << above;
    EXPECT_EQ(face.pieces[1].morphs[0].moves.deltas[3].z, -0.5f);
  }
  Forehead lashes;
  lashes.hair.name = "Lashes";
  lashes.move_brows(0, {0, 0, -0.5f});
  EXPECT_EQ(lashes.keep(), 0u);
}

TEST(BrowClearance, VRoidKeepsItsBrows) {
  const auto path = test::shared_dir() / "data" / "avatars" / "vroid.glb";
  if (test::shared_dir().empty() || !std::filesystem::exists(path)) {
    GTEST_SKIP() << "no reference data";
  }
  const auto source = read_head_file(path.string(), {.vertices = 0});
  ASSERT_TRUE(source) << source.error().describe();
  EXPECT_THAT(source->notes,
              testing::Contains(testing::HasSubstr("the skin hid parts of the brows")));
}

}  // namespace brow_clearance_test
}  // namespace animeme::gltf
