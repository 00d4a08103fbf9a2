// Xface files by hand: what the numbers mean, and what is refused.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "fap/xml/fdp.h"
#include "tests/support/shared.h"
#include "tests/xml/deltas.h"

namespace animeme::test {
namespace fdp_read_test {

using head::Source;
using head::Vec3;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

Result<std::string> load_data(const std::string& name) {
  if (name.starts_with("mask.")) return data_file("heads/" + name);
  return make_error(Code::not_found, "there is no file " + name);
}

Source source_of(const std::string& text) {
  auto source = head::read_fdp(text, load_data);
  EXPECT_TRUE(source) << source.error().describe();
  return source ? std::move(*source) : Source{};
}
Source mask() { return source_of(data_file("heads/mask.fdp")); }

// What one unit of a FAP does to a vertex of a piece.
Vec3 delta(const Source& source, int fap, std::uint32_t vertex, std::size_t piece = 0) {
  return moved(source, fap, 1, vertex, piece);
}

float bell(double d, double farthest) { return float(std::cos(M_PI * d / farthest) + 1); }

TEST(FdpRead, RaisedCosinesInUnitsOfTheFace) {
  const Source source = mask();
  const float mns = 30.0f / 1024;
  // FAP 3 is fap="2". From the chin, vertices 3 and 4 are farthest.
  const double farthest = std::hypot(25, 20);
  expect_near(delta(source, 3, 0), {0, -mns, 0});
  expect_near(delta(source, 3, 2), {0, -mns * 0.5f * bell(std::hypot(18, 10), farthest), 0});
  expect_near(delta(source, 3, 3), {});
  expect_near(delta(source, 3, 1), {});  // not in the region
  expect_near(delta(source, 14, 0), {0, 0, 0.5f * mns});
}

TEST(FdpRead, WavesAndSums) {
  const Source source = mask();
  const float mw = 50.0f / 1024;
  expect_near(delta(source, 53, 3), {mw, 0, 0});
  // By X all of 1 and 2 are 25 away. By Y of vertex 4, 2 is 2 away and 1 and 4 are not; negative.
  expect_near(delta(source, 53, 1), {-0.2f * mw, 0, 0});
  expect_near(delta(source, 53, 2), {});
  expect_near(delta(source, 53, 4), {-0.2f * mw, 0, 0});
  // FAP 19 counts in MNS and comes forward, as in Xface. By Z of vertex 4 both are 10 away.
  expect_near(delta(source, 19, 4), {0, -30.0f / 1024, 0.5f * 30 / 1024});
  expect_near(delta(source, 19, 1), {});
}

TEST(FdpRead, PointsEyesUnitsAndNotes) {
  const Source source = mask();
  ASSERT_THAT(source.pieces, SizeIs(3));
  EXPECT_EQ(source.pieces[1].name, "LeftEye");
  ASSERT_THAT(source.points, SizeIs(4));  // the first 2.1 counts, names of no point do not
  EXPECT_EQ(source.points[0].id, "2.1");
  EXPECT_EQ(source.points[0].piece, 0u);
  ASSERT_TRUE(source.fapu);
  EXPECT_EQ(source.fapu->mw, 50);
  EXPECT_EQ(source.fapu->ens, 51.2);
  ASSERT_TRUE(source.eyes[0] && source.eyes[1]);
  expect_near(*source.eyes[0], {32, 0, -5});
  expect_near(*source.eyes[1], {-32, 0, -5});
  EXPECT_THAT(source.notes, Contains(HasSubstr("2 visemes, expressions and modifiers")));
  EXPECT_THAT(source.notes, Contains(HasSubstr("'Wobble' is unknown")));
  EXPECT_THAT(source.notes, Contains(HasSubstr("1 <fdp> elements refer to meshes")));
  EXPECT_THAT(source.notes, Contains(HasSubstr("line 12: <bind> refers to no mesh")));
  EXPECT_THAT(source.notes, Contains(HasSubstr("move no vertex are ignored: 49")));
  auto head = head::assemble(source);
  ASSERT_TRUE(head) << head.error().describe();
  EXPECT_NEAR(head->fapu.es, 6.4, 1e-5);  // taken for millimetres
}

// Both signs of pivots are in use.
TEST(FdpRead, PivotsAreCentresEitherWay) {
  std::string text = data_file("heads/mask.fdp");
  text = replaced(text, "pivotX=\"-32\" pivotY=\"0\" pivotZ=\"5\"", "pivotX=\"32\" pivotZ=\"-5\"");
  const Source source = source_of(text);
  expect_near(*source.eyes[0], {32, 0, -5});
  expect_near(*source.eyes[1], {-32, 0, -5});
}

TEST(FdpRead, ObjMeshesAreCountedThroughTheFile) {
  std::string text = replaced(data_file("heads/mask.fdp"), "\"mask.wrl\"", "\"mask.obj\"");
  text = replaced(text, "mask.wrl_0", "face");
  text = replaced(text, "\"eye\" index=\"4\"", "\"eyeLeft\" index=\"13\"");
  text = replaced(text, "submesh=\"eye\"", "submesh=\"eyeLeft\"");
  text = replaced(text, "submesh=\"mask.wrl_1\"", "submesh=\"eyeRight\"");
  const Source obj = source_of(text);
  const Source wrl = mask();
  ASSERT_THAT(obj.points, SizeIs(wrl.points.size()));
  for (std::size_t i = 0; i < obj.points.size(); ++i) {
    const auto place = [&](const Source& s) {
      return s.pieces[s.points[i].piece].mesh.positions[s.points[i].vertex];
    };
    EXPECT_EQ(place(obj), place(wrl)) << obj.points[i].id;
  }
  // Vertices of pieces are in the order of the faces there.
  const std::size_t face = obj.points[0].piece;
  const auto& places = obj.pieces[face].mesh.positions;
  for (std::uint32_t v = 0; v < 9; ++v) {
    const auto same = std::find(places.begin(), places.end(), wrl.pieces[0].mesh.positions[v]);
    ASSERT_NE(same, places.end());
    for (const int fap : {3, 14, 19, 53}) {
      expect_near(delta(obj, fap, std::uint32_t(same - places.begin()), face), delta(wrl, fap, v));
    }
  }
}

TEST(FdpRead, TheNinthInfluenceOnAVertexIsLost) {
  std::string many = "<fdp affects=\"mask.wrl_0\" index=\"7\" name=\"11.1\"><indices>7 8</indices>";
  for (int i = 0; i < 9; ++i) {
    many += "<influence fap=\"3\" type=\"RaisedCosInfluenceSph\" weight=\"0.05\"/>";
  }
  const Source source =
      source_of(replaced(data_file("heads/mask.fdp"), "</xfdp>", many + "</fdp></xfdp>"));
  expect_near(delta(source, 4, 7), {0, -0.8f * 30 / 1024, 0});
  EXPECT_THAT(source.notes, Contains(HasSubstr("1 influences beyond the eighth")));
}

class FdpErrors : public ::testing::TestWithParam<Damage> {};

TEST_P(FdpErrors, NameThePlaceAndTheRemedy) {
  const auto source = head::read_fdp(
      replaced(data_file("heads/mask.fdp"), GetParam().from, GetParam().to), load_data);
  expect_refused(source, GetParam());
}

INSTANTIATE_TEST_SUITE_P(
    All, FdpErrors,
    ::testing::Values(
        Damage{"</xfdp>", "", Code::syntax, 36, ""},
        Damage{"xfdp", "svg", Code::syntax, 4, "not an Xface file"},
        Damage{"ES0=\"64\"", "ES0=\"6 4\"", Code::syntax, 6, "ES0 of <fapu> needs one number"},
        Damage{"ES0=\"64\"", "ES0=\"x\"", Code::syntax, 6, "'x', which is no number"},
        Damage{"alias=\"Rest\"", "alias=\"Peace\"", Code::not_found, 7, "\"Rest\""},
        Damage{"file=\"mask.wrl\"", "file=\"other.wrl\"", Code::not_found, 9,
               "no mesh file \"other.wrl\""},
        Damage{"file=\"mask.wrl\"", "file=\"../mask.wrl\"", Code::invalid_argument, 9,
               "not in the folder"},
        Damage{"file=\"mask.wrl\"", "file=\"mask.wrl\" path=\"/etc/\"", Code::invalid_argument, 9,
               "not in the folder"},
        Damage{"file=\"mask.wrl\"", "file=\"mask.max\"", Code::unsupported, 9, "neither .wrl"},
        Damage{"index=\"3\"", "index=\"9\"", Code::out_of_range, 24, "mask.wrl_0 has 9 vertices"},
        Damage{"index=\"3\"", "index=\"-1\"", Code::out_of_range, 24, "0..8"},
        Damage{"index=\"3\"", "", Code::syntax, 24, "index of <fdp> is missing"},
        Damage{"<indices>1 2 3<", "<indices>1 2 9<", Code::out_of_range, 24, "has 9 vertices"},
        Damage{"<indices>1 2 3<", "<indices>1 2.5 3<", Code::syntax, 24, "invalid vertex index"},
        Damage{"fap=\"13\"", "fap=\"68\"", Code::out_of_range, 21, "FAP 1 is number 0"},
        Damage{"affects=\"", "affects=\"other_", Code::not_found, 4, "mask.wrl_0, eye"},
        Damage{"<!-- By hand", "<!DOCTYPE xfdp [<!ENTITY a \"b\">]><!-- By hand", Code::unsupported,
               2, "DOCTYPE"},
        Damage{"\" 50 \"", "\"&a;\"", Code::syntax, 5, "Entity 'a' not defined"}));

// Files that name files, or that are larger than they look.
TEST(FdpRead, BombsAreRefused) {
  const std::string outside =
      "<!DOCTYPE xfdp SYSTEM \"file:///etc/passwd\" [<!ENTITY % p SYSTEM \"file:///etc/passwd\"> "
      "%p;]><xfdp/>";
  const auto refused = head::read_fdp(outside, load_data);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::unsupported);
  std::string laughs = "<!DOCTYPE xfdp [<!ENTITY a0 \"ha\">";
  for (int i = 1; i < 40; ++i) {
    const std::string before = "&a" + std::to_string(i - 1) + ";";
    laughs += "<!ENTITY a" + std::to_string(i) + " \"" + before + before + "\">";
  }
  EXPECT_EQ(head::read_fdp(laughs + "]><xfdp>&a39;</xfdp>", load_data).error().code,
            Code::unsupported);
  std::string crowd = "<xfdp ";
  for (int i = 0; i < 100000; ++i) crowd += "a" + std::to_string(i) + "='' ";
  EXPECT_EQ(head::read_fdp(crowd + "/>", load_data).error().code, Code::out_of_range);
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_EQ(head::read_fdp(deep, load_data).error().code, Code::out_of_range);
}

}  // namespace fdp_read_test
}  // namespace animeme::test
