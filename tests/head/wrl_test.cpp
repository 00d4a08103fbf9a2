// VRML97 files: what is read, what is refused and where, and what comes back of what is written.
#include "fap/head/wrl.h"

#include <gmock/gmock.h>

#include "fap/head/srgb.h"
#include "tests/head/head_support.h"
#include "tests/support/shared.h"

namespace animeme::test {
namespace wrl_test {

using head::Piece;
using head::read_wrl;
using head::Triangle;
using head::Vec3;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

void expect_near(Vec3 a, Vec3 b) {
  EXPECT_LT(length(a - b), 1e-5f) << a.x << " " << a.y << " " << a.z;
}

TEST(Wrl, ReadsWhatMeshesNeed) {
  const auto pieces = read_wrl(data_file("heads/quirks.wrl"));
  ASSERT_TRUE(pieces) << pieces.error().describe();
  ASSERT_THAT(*pieces, SizeIs(2));
  const Piece& face = pieces->front();
  EXPECT_EQ(face.name, "face");
  EXPECT_EQ(face.material, "skin");
  ASSERT_THAT(face.mesh.positions, SizeIs(5));
  EXPECT_THAT(face.mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  // Twice as large, a quarter turn about Z, then shifted.
  expect_near(face.mesh.positions[0], {1, 2, 3});
  expect_near(face.mesh.positions[1], {1, 4, 3});
  expect_near(face.mesh.positions[3], {-1, 2, 3});
  expect_near(face.mesh.colours[2], {1, 0, 0});
}

TEST(Wrl, UseOrderAndColoursOfFaces) {
  const auto pieces = read_wrl(data_file("heads/quirks.wrl"));
  ASSERT_TRUE(pieces);
  const Piece& lid = pieces->back();
  EXPECT_EQ(lid.name, "lid");
  EXPECT_THAT(lid.mesh.triangles, ElementsAre(Triangle{0, 2, 1}, Triangle{0, 3, 2}));
  expect_near(lid.mesh.colours[1], {1, 1, 1});
  expect_near(lid.mesh.colours[3], {0, 0, 0});
  const float grey = head::linear_of_srgb(0.5f);  // of two faces
  expect_near(lid.mesh.colours[0], {grey, grey, grey});
}

struct Refused {
  const char* text;
  Code code;
  std::int64_t line;
  std::int64_t column;
  const char* message;
};

class WrlErrors : public ::testing::TestWithParam<Refused> {};

TEST_P(WrlErrors, NameThePlace) {
  const auto pieces = read_wrl(GetParam().text);
  ASSERT_FALSE(pieces);
  EXPECT_EQ(pieces.error().code, GetParam().code);
  EXPECT_EQ(pieces.error().where.line, GetParam().line) << pieces.error().describe();
  EXPECT_EQ(pieces.error().where.column, GetParam().column) << pieces.error().describe();
  EXPECT_THAT(pieces.error().message, HasSubstr(GetParam().message));
}

#define FACES(fields) "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet {\n" fields "\n} }"
INSTANTIATE_TEST_SUITE_P(
    All, WrlErrors,
    ::testing::Values(
        Refused{"", Code::not_found, 0, 0, "no Shape"},
        Refused{"#VRML V1.0 ascii\nSeparator { }", Code::unsupported, 1, 1, "VRML 1.0"},
        Refused{"\x1f\x8b\x08", Code::unsupported, 1, 1, "gunzip"},
        Refused{"#VRML V2.0 utf8\n  Shape {", Code::truncated, 2, 10, "begins in line 2"},
        Refused{"#VRML V2.0 utf8\nUSE x", Code::syntax, 2, 5, "'x'"},
        Refused{"#VRML V2.0 utf8\nDEF a Group { children USE a }", Code::syntax, 2, 28, "'a'"},
        Refused{"#VRML V2.0 utf8\n} ", Code::syntax, 2, 1, "'}'"},
        Refused{"<html>", Code::syntax, 1, 7, "'{'"},
        Refused{FACES("coord Coordinate { point [ 0 0 0 1 ] }"), Code::syntax, 3, 26, "threes"},
        Refused{FACES("coord Coordinate { point [ 0 0 1e999 ] }"), Code::out_of_range, 3, 26,
                "not finite"},
        Refused{FACES("coord Coordinate { point [ 0 0 0 ] }\ncoordIndex [ 0 0 7 ]"),
                Code::out_of_range, 4, 12, "vertex 7 is named, but there are 1"},
        Refused{FACES("coordIndex [ 0 0.5 ]"), Code::syntax, 3, 12, "invalid index"},
        Refused{FACES("coord Coordinate { point [ 0 0 0 ] } color Color { color [ ] }\n"
                      "coordIndex [ 0 0 0 ]"),
                Code::not_found, 0, 0, "no Shape"},
        Refused{FACES("coord Coordinate { point [ 0 0 0 1 1 1 ] }\ncoordIndex [ 0 1 0 ]\n"
                      "color Color { color [ 1 1 1 ] }"),
                Code::out_of_range, 5, 7, "colour 1 is named"}));
#undef FACES

// Names that double the scene each time, nodes within nodes: refused, not tried.
TEST(Wrl, BombsAreRefused) {
  std::string text = "#VRML V2.0 utf8\nDEF a0 Group { }\n";
  for (int i = 1; i < 60; ++i) {
    const std::string before = "a" + std::to_string(i - 1);
    text += "DEF a" + std::to_string(i) + " Group { children [ USE " + before + " USE " + before +
            " ] }\n";
  }
  EXPECT_EQ(read_wrl(text).error().code, Code::out_of_range);
  std::string deep = "#VRML V2.0 utf8\n";
  for (int i = 0; i < 100000; ++i) deep += "Group { children ";
  EXPECT_EQ(read_wrl(deep).error().code, Code::out_of_range);
  std::string chain = "#VRML V2.0 utf8\nDEF a Group { }\n";
  for (int i = 0; i < 100000; ++i) chain += "DEF a Group { children USE a }\n";
  EXPECT_EQ(read_wrl(chain).error().code, Code::out_of_range);
}

TEST(Wrl, WrittenPiecesComeBack) {
  const head::Head& head = head_of("child");
  std::vector<Piece> pieces;
  for (const head::Part part : {head::Part::skin, head::Part::tongue, head::Part::left_eye}) {
    pieces.push_back({std::string(head::kPartNames[std::size_t(part)]), "m", head.part(part), {}});
  }
  const auto again = read_wrl(head::write_wrl(pieces));
  ASSERT_TRUE(again) << again.error().describe();
  ASSERT_THAT(*again, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*again)[i].name, pieces[i].name);
    EXPECT_EQ((*again)[i].material, "m");
    EXPECT_EQ((*again)[i].mesh.positions, pieces[i].mesh.positions);
    EXPECT_EQ((*again)[i].mesh.triangles, pieces[i].mesh.triangles);
    for (std::size_t v = 0; v < pieces[i].mesh.colours.size(); ++v) {
      ASSERT_LT(length((*again)[i].mesh.colours[v] - pieces[i].mesh.colours[v]), 0.003f);
    }
  }
}

}  // namespace wrl_test
}  // namespace animeme::test
