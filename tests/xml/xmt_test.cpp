// Faces in XMT-A: our heads written and read again, a file by hand, and what is refused.
#include "fap/xml/xmt.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/head/head_support.h"
#include "tests/support/shared.h"
#include "tests/xml/deltas.h"

namespace animeme::test {
namespace xmt_test {

using head::Head;
using head::Part;
using head::Rig;
using head::Source;
using head::Vec3;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

Source mask() {
  auto source = head::read_xmt(data_file("heads/mask.xmta"));
  EXPECT_TRUE(source) << source.error().describe();
  return source ? std::move(*source) : Source{};
}

// The numbers of the example are known: FAP value 600 moves the first vertex by (600, 0, 400) and
// the second by (550, 0, 0) FAPU.
TEST(XmtRead, TablesArePiecesOfStraightMoves) {
  const Source source = mask();
  const float unit = 20.0f / 1024;  // MNS
  expect_near(moved(source, 4, 600, 2), Vec3{500 * 0.9f + 100 * 1.5f, 0, 400} * unit);
  expect_near(moved(source, 4, 600, 1), Vec3{500 * 0.7f + 100 * 2, 0, 0} * unit);
  expect_near(moved(source, 4, -300, 2), Vec3{-300, 0, 0} * unit);
  expect_near(moved(source, 4, 5000, 2), moved(source, 4, 1000, 2));
  expect_near(moved(source, 4, -5000, 2), moved(source, 4, -1000, 2));
  expect_near(moved(source, 4, 0, 2), {});
}

TEST(XmtRead, OneIntervalIsStraightForAllValues) {
  const Source source = mask();
  expect_near(moved(source, 6, 400, 3), Vec3{400, 0, 0} * (50.0f / 1024));
  expect_near(moved(source, 6, -400, 3), Vec3{-400, 0, 0} * (50.0f / 1024));
}

TEST(XmtRead, TransformsTurnAndTellWhere) {
  const Source source = mask();
  ASSERT_THAT(source.pieces, SizeIs(3));
  ASSERT_TRUE(source.eyes[0]);
  ASSERT_TRUE(source.eyes[1]);  // from its pupil: there is no mesh
  expect_near(*source.eyes[1], {-32, 0, 5 - 0.19f * 64});
  expect_near(*source.eyes[0], {32, 0, -5});
  ASSERT_TRUE(source.jaw_axis && source.neck_pivot);
  expect_near(*source.jaw_axis, {0, -10, -60});
  expect_near(*source.neck_pivot, {0, -62, -21});
  EXPECT_EQ(source.pieces[2].name, "beard");
  const Vec3 arm = Vec3{0, -60, 10} - Vec3{0, -10, -60};
  expect_near(moved(source, 3, 100, 0, 2), cross(Vec3{1, 0, 0}, arm) * (0.02f * 100 * 20 / 1024));
  EXPECT_THAT(source.notes, Contains(HasSubstr("with a scale")));
  EXPECT_THAT(source.notes, Contains(HasSubstr("tables of visemes")));
  EXPECT_THAT(source.notes, Contains(HasSubstr("USE of nobody")));
  EXPECT_THAT(source.notes, Contains(HasSubstr("1 tables refer to no mesh")));
}

TEST(XmtRead, PointsAreTheNearestVertices) {
  const Source source = mask();
  const auto place = [&](const std::string& id) {
    const auto p = std::find_if(source.points.begin(), source.points.end(),
                                [&](const head::PiecePoint& point) { return point.id == id; });
    return p == source.points.end() ? Vec3{} : source.pieces[p->piece].mesh.positions[p->vertex];
  };
  expect_near(place("2.1"), {0, -60, 0});
  expect_near(place("8.1"), {0, -40, 10});
  expect_near(place("3.5"), {32, 0, 5});
  EXPECT_THAT(source.notes, Contains(HasSubstr("the farthest is 1.5 units away (8.1)")));
  EXPECT_THAT(source.notes, Contains(HasSubstr("no vertex is near these feature points")));
  ASSERT_TRUE(source.fapu);
  EXPECT_DOUBLE_EQ(source.fapu->es, 64);
  EXPECT_DOUBLE_EQ(source.fapu->mns, 20);
  EXPECT_DOUBLE_EQ(source.fapu->mw, 50);
  // Clockwise faces are turned, colours are linear.
  EXPECT_EQ(source.pieces[0].mesh.triangles[0], (head::Triangle{0, 3, 2}));
  expect_near(source.pieces[0].mesh.colours[8], {0, 0, 0});
  auto head = head::assemble(source);
  EXPECT_TRUE(head) << head.error().describe();
}

// A large table that is used again and again.
TEST(XmtRead, BombsAreRefused) {
  std::string table = "<FaceDefMesh DEF=\"t\" coordIndex=\"";
  std::string moves;
  for (int i = 0; i < 20000; ++i) {
    table += "1 ";
    moves += "0 0.5 0 ";
  }
  table += "\" displacements=\"" + moves +
           "\"><faceSceneGraphNode><IndexedFaceSet USE=\"face\"/></faceSceneGraphNode>"
           "</FaceDefMesh>";
  for (int i = 0; i < 2000; ++i) table += "<FaceDefMesh USE=\"t\"/>";
  const std::string begin = "<FaceDefTables fapID=\"1\"";
  const auto source = head::read_xmt(replaced(data_file("heads/mask.xmta"), begin,
                                              "<FaceDefTables fapID=\"5\"><faceDefMesh>" + table +
                                                  "</faceDefMesh></FaceDefTables>" + begin));
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Code::out_of_range);
  EXPECT_THAT(source.error().message, HasSubstr("4 million"));
}

class XmtErrors : public ::testing::TestWithParam<Damage> {};

TEST_P(XmtErrors, NameThePlaceAndTheRemedy) {
  const auto source =
      head::read_xmt(replaced(data_file("heads/mask.xmta"), GetParam().from, GetParam().to));
  expect_refused(source, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    All, XmtErrors,
    ::testing::Values(
        Damage{"m:FDP", "m:FIT", Code::not_found, 3, "no FDP node"},
        Damage{"faceSceneGraph>", "faceSceneGraf>", Code::not_found, 6, "no mesh"},
        Damage{"featurePointsCoord>", "featurePoint>", Code::not_found, 6, "featurePointsCoord"},
        Damage{"    0 -20 15\n", "    3e38 3e38 3e38\n", Code::not_found, 6, "9.15"},
        Damage{"fapID=\"4\"", "fapID=\"69\"", Code::out_of_range, 8, "1..68"},
        Damage{"-1000, 0 500", "-1000, 500 0", Code::syntax, 10, "do not ascend"},
        Damage{"2 0 0\">", "2 0\">", Code::syntax, 10, "17 numbers; 2 vertices and 3 intervals"},
        Damage{"coordIndex=\"2 1\"", "coordIndex=\"2 9\"", Code::out_of_range, 10, "vertex 9 of 9"},
        Damage{"coordIndex=\"2 1\"", "coordIndex=\"2 x\"", Code::syntax, 10, "'x'"},
        Damage{"rotationDef=\"0 1 0 1\"", "rotationDef=\"0 1 0\"", Code::syntax, 21,
               "four numbers"},
        Damage{"0,4,2,-1", "0,4,9,-1", Code::out_of_range, 118, "vertex 9 is named"},
        Damage{"<Transform DEF=\"eye\"", "<Transform DEF=\"eye\" rotation=\"1 0 0\"", Code::syntax,
               122, "four numbers"},
        Damage{"<Shape DEF=\"eyeLeft\">", "<Transform USE=\"eye\"/><Shape DEF=\"eyeLeft\">",
               Code::syntax, 123, "contains itself"},
        Damage{"<!DOCTYPE XMT-A>", "<!DOCTYPE XMT-A [<!ENTITY a \"b\">]>", Code::unsupported, 2,
               "DOCTYPE"}));

class XmtHead : public ::testing::TestWithParam<std::string> {
 protected:
  const Head& head() const { return head_of(GetParam()); }
  const Rig& rig() const { return rig_of(GetParam()); }
  const std::string& text() const {
    static std::map<std::string, std::string> texts;
    auto found = texts.find(GetParam());
    if (found == texts.end()) {
      auto written = head::write_xmt(head(), rig());
      EXPECT_TRUE(written) << written.error().describe();
      found = texts.emplace(GetParam(), std::move(*written)).first;
    }
    return found->second;
  }
  const Head& again() const {
    static std::map<std::string, Head> heads;
    auto found = heads.find(GetParam());
    if (found == heads.end()) {
      auto source = head::read_xmt(text());
      EXPECT_TRUE(source) << source.error().describe();
      auto made = head::assemble(std::move(*source));
      EXPECT_TRUE(made) << made.error().describe();
      found = heads.emplace(GetParam(), std::move(*made)).first;
    }
    return found->second;
  }
};
INSTANTIATE_TEST_SUITE_P(Heads, XmtHead, ::testing::Values("woman"));

TEST_P(XmtHead, MeshesAndPointsComeBack) {
  const Head& back = again();
  const Vec3 shift = back.part(Part::skin).positions[0] - head().part(Part::skin).positions[0];
  EXPECT_LT(length(shift), 1);
  for (std::size_t p = 0; p < head::kPartCount; ++p) {
    const head::Mesh& was = head().parts[p];
    const head::Mesh& is = back.parts[p];
    ASSERT_EQ(is.positions.size(), was.positions.size()) << head::kPartNames[p];
    EXPECT_EQ(is.triangles, was.triangles) << head::kPartNames[p];
    for (std::size_t v = 0; v < is.positions.size(); ++v) {
      ASSERT_LT(length(is.positions[v] - was.positions[v] - shift), 0.02f) << head::kPartNames[p];
      ASSERT_LT(length(is.colours[v] - was.colours[v]), 0.01f) << head::kPartNames[p];
    }
  }
  int same = 0;
  for (const fap::FeaturePointInfo& info : fap::kFeaturePoints) {
    if (!head().point(info.id).exists()) continue;
    ASSERT_TRUE(back.point(info.id).exists()) << info.id;
    // Another vertex may be in the same place.
    EXPECT_LT(length(back.at(info.id) - head().at(info.id) - shift), 0.02f) << info.id;
    ++same;
  }
  EXPECT_GT(same, 80);
}

TEST_P(XmtHead, EachFapMovesItsPointAsFarAsTheTableSays) {
  const Head& back = again();
  const Rig moving = head::make_rig(back);
  EXPECT_GT(expect_table_moves(back, moving, {400, -300}), 100);
}

// A whole face moves as before, all FAPs at once.
TEST_P(XmtHead, TheFaceMovesAsBefore) {
  const Head& back = again();
  const Rig moving = head::make_rig(back);
  fap::Frame frame;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    // Our lids and lashes make way for eyes that come out, which no table says.
    if (fap != 27 && fap != 28) frame.set(fap, 60 + fap);
  }
  for (const int fap : {23, 24, 25, 26, 48, 49, 50}) frame.set(fap, 10000);
  const head::Pose before = head::pose(rig(), frame);
  const head::Pose after = head::pose(moving, frame);
  const Vec3 shift = back.part(Part::skin).positions[0] - head().part(Part::skin).positions[0];
  for (std::size_t p = 0; p < head::kPartCount; ++p) {
    const auto& was = before.positions[p].empty() ? rig().parts[p].positions : before.positions[p];
    const auto& is = after.positions[p].empty() ? moving.parts[p].positions : after.positions[p];
    double squares = 0;
    for (std::size_t v = 0; v < was.size(); ++v) {
      const Vec3 d = after.transforms[p](is[v]) - before.transforms[p](was[v]) - shift;
      squares += double(dot(d, d));
    }
    EXPECT_LT(std::sqrt(squares / double(was.size())), 0.05) << head::kPartNames[p];
  }
}

TEST_P(XmtHead, SizeIsReasonable) {
  EXPECT_LT(text().size(), 9'000'000u);
  const auto again = head::write_xmt(head(), rig());
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, text());
}

TEST(XmtWrite, SaysWhyItCannot) {
  Head bare = head_of("child");
  bare.feature_points.fill({});
  const auto no_points = head::write_xmt(bare, rig_of("child"));
  ASSERT_FALSE(no_points);
  EXPECT_THAT(no_points.error().message, HasSubstr("no feature points"));
}

}  // namespace xmt_test
}  // namespace animeme::test
