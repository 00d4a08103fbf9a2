// Heads of others: OBJ files, lists of landmarks, and what assemble() makes of them.
#include "fap/head/own_head.h"

#include <gmock/gmock.h>

#include <functional>

#include "fap/head/obj.h"
#include "fap/head/point_list.h"
#include "tests/head/head_support.h"
#include "tests/head/outside.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"

namespace animeme::test {
namespace own_head_test {

using head::Head;
using head::Part;
using head::Vec3;
using ::testing::Contains;
using ::testing::HasSubstr;

using Change = std::function<Vec3(Vec3)>;

struct ObjHead {
  std::string obj;
  std::string points;
};

// A head of ours as the OBJ file and the list that a user would have.
ObjHead obj_of(const Head& head, const Change& change) {
  Head changed = head;
  changed.part(Part::lashes) = {};
  for (head::Mesh& mesh : changed.parts) {
    for (Vec3& p : mesh.positions) p = change(p);
  }
  return {head::write_obj(changed), head::points_of(changed)};
}

Result<Head> read(const ObjHead& files, std::vector<std::string>* notes = nullptr) {
  Result<head::ObjFile> file = head::read_obj(files.obj);
  if (!file) return file.error();
  const auto rows = head::read_points(files.points);
  if (!rows) return rows.error();
  auto points = head::points_on(*file, *rows);
  if (!points) return points.error();
  head::Source source;
  source.pieces = std::move(file->pieces);
  source.points = std::move(*points);
  return head::assemble(std::move(source), notes);
}

TEST(OwnHead, MovesAsTheTableSaysInAnyUnitAndWithAnyAxes) {
  const Head& man = head_of("man");
  const struct {
    Change change;
    const char* note;
  } cases[] = {
      {[](Vec3 p) { return p; }, ""},
      {[](Vec3 p) { return p * 0.01f; }, "metres"},
      {[](Vec3 p) {
         return Vec3{p.x, -p.z, p.y} * 10.0f + Vec3{50, 60, 70};
       },
       "rotated"},
      {[](Vec3 p) { return p * 1000.0f; }, "pupil distance of 6.3 cm"},
  };
  for (const auto& test : cases) {
    std::vector<std::string> notes;
    const Result<Head> head = read(obj_of(man, test.change), &notes);
    ASSERT_TRUE(head) << head.error().describe();
    if (*test.note) {
      EXPECT_THAT(notes, Contains(HasSubstr(test.note)));
    }
    const double scale = head->fapu.es / man.fapu.es;
    if (std::string(test.note) == "pupil distance of 6.3 cm") {
      EXPECT_NEAR(head->fapu.es, 6.3, 0.01);
    } else {
      EXPECT_NEAR(scale, 1, 1e-3);
    }
    EXPECT_NEAR(head->fapu.mw / man.fapu.mw, scale, 2e-3);
    for (const char* id : {"2.1", "8.3", "4.2", "9.3"}) {
      const Vec3 wanted = (man.at(id) - man.at("3.5")) * float(scale);
      EXPECT_LT(length(head->at(id) - head->at("3.5") - wanted), 0.01) << id;
    }
    EXPECT_GT(expect_table_moves(*head, head::make_rig(*head), {300}, Part::skin), 40);
  }
}

TEST(OwnHead, PartsAreKnownByTheirNames) {
  const Head& woman = head_of("woman");
  const Result<Head> head = read(obj_of(woman, [](Vec3 p) { return p; }));
  ASSERT_TRUE(head);
  for (std::size_t part = 0; part < head->parts.size(); ++part) {
    const std::size_t wanted = Part(part) == Part::lashes ? 0 : woman.parts[part].positions.size();
    EXPECT_EQ(head->parts[part].positions.size(), wanted) << head::kPartNames[part];
    EXPECT_EQ(head->parts[part].colours.size(), wanted);
    EXPECT_EQ(head->parts[part].occlusion.size(), wanted);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    EXPECT_LT(length(head->eyes[side].centre - woman.eyes[side].centre), 0.1);
    EXPECT_NEAR(head->eyes[side].radius, woman.eyes[side].radius, 0.05);
  }
  using head::part_by_name;
  EXPECT_EQ(part_by_name("Wolf3D_Teeth", ""), Part::lower_teeth);
  EXPECT_EQ(part_by_name("Head", "M_ScleraRight"), Part::right_eye);
  EXPECT_EQ(part_by_name("EyeLeft", ""), Part::left_eye);
  EXPECT_EQ(part_by_name("eyelashes", ""), Part::lashes);
  EXPECT_EQ(part_by_name("Wolf3D_Glasses", ""), Part::hair);
  EXPECT_EQ(part_by_name("", ""), Part::skin);
  EXPECT_EQ(part_by_name("face", "EyeOcclusion"), std::nullopt);
}

TEST(OwnHead, EyesAndTeethInOneMeshAreToldApartByTheirPlace) {
  Head mixed = head_of("child");
  const auto join = [&](Part from, Part to) {
    const auto first = std::uint32_t(mixed.part(to).positions.size());
    const head::Mesh& parting = mixed.part(from);
    head::Mesh& growing = mixed.part(to);
    for (std::size_t v = 0; v < parting.positions.size(); ++v) {
      growing.positions.push_back(parting.positions[v]);
      growing.colours.push_back(parting.colours[v]);
      growing.occlusion.push_back(parting.occlusion[v]);
    }
    for (head::Triangle t : mixed.part(from).triangles) {
      for (std::uint32_t& v : t) v += first;
      mixed.part(to).triangles.push_back(t);
    }
    mixed.part(from) = {};
  };
  const std::size_t eye = mixed.part(Part::right_eye).positions.size();
  const std::size_t teeth = mixed.part(Part::upper_teeth).positions.size();
  join(Part::right_eye, Part::left_eye);
  join(Part::upper_teeth, Part::lower_teeth);
  for (head::FeaturePoint& point : mixed.feature_points) {
    const bool gone = point.part == Part::right_eye || point.part == Part::upper_teeth;
    if (gone) point.vertex = head::kMissing;
  }
  ObjHead files = obj_of(mixed, [](Vec3 p) { return p; });
  const std::size_t at = files.obj.find("g lower_teeth");
  files.obj.replace(at, 13, "g teeth      ");
  const Result<Head> head = read(files);
  ASSERT_TRUE(head) << head.error().describe();
  EXPECT_EQ(head->part(Part::right_eye).positions.size(), eye);
  EXPECT_EQ(head->part(Part::upper_teeth).positions.size(), teeth);
}

TEST(OwnHead, AClosedMouthIsDarkInsideAndTheNoseIsNot) {
  const Result<Head> head = read(obj_of(head_of("woman"), [](Vec3 p) { return p; }));
  ASSERT_TRUE(head);
  const head::Mesh& skin = head->part(Part::skin);
  EXPECT_GT(skin.occlusion[head->point("9.3").vertex], 0.6f);
  const Vec3 lip = head->at("2.2");
  int inside = 0;
  for (std::size_t v = 0; v < skin.positions.size(); ++v) {
    const Vec3 d = skin.positions[v] - lip;
    if (std::abs(d.x) > 1 || std::abs(d.y) > 1.5f || d.z > -1.5f || d.z < -6) continue;
    ++inside;
    EXPECT_LT(skin.occlusion[v], 0.25f);
  }
  EXPECT_GT(inside, 20);
}

// A mesh without colours of its own.
TEST(OwnHead, LipsAreEvenlyRedAndTheMouthIsDarkWithin) {
  Head woman = head_of("woman");
  woman.part(Part::skin).colours.clear();
  const Result<Head> head = read(obj_of(woman, [](Vec3 p) { return p; }));
  ASSERT_TRUE(head);
  const head::Mesh& skin = head->part(Part::skin);
  ASSERT_EQ(skin.positions.size(), woman.part(Part::skin).positions.size());
  const auto light = [&skin](std::uint32_t v) {
    return (skin.colours[v].x + skin.colours[v].y + skin.colours[v].z) / 3;
  };
  std::vector<bool> seen(skin.positions.size());
  for (const head::Triangle& t : outside_of(woman, true)) {
    for (const std::uint32_t v : t) seen[v] = true;
  }
  const float mns = float(head->fapu.mns);
  const Vec3 lip = head->at("2.2");
  int dark = 0;
  for (std::uint32_t v = 0; v < seen.size(); ++v) {
    const Vec3 d = skin.positions[v] - lip;
    if (seen[v]) {
      EXPECT_GT(light(v), 0.2f) << v;
    } else if (std::abs(d.y) < mns && d.z < -0.5f * mns && d.z > -3 * mns &&
               std::abs(d.x) < 0.4f * float(head->fapu.mw)) {
      EXPECT_LT(light(v), 0.1f) << v;
      ++dark;
    }
  }
  EXPECT_GT(dark, 100);
  // On the border of the lips, where colours are half and half.
  for (const auto& [left, right] : {std::pair("8.10", "8.9"), {"8.5", "8.6"}, {"8.7", "8.8"}}) {
    EXPECT_NEAR(light(head->point(left).vertex), light(head->point(right).vertex), 0.03f) << left;
  }
}

TEST(OwnHead, SaysWhatIsMissingAndWhatCannotBe) {
  const ObjHead all = obj_of(head_of("man"), [](Vec3 p) { return p; });
  ObjHead few = all;
  few.points = "";
  for (const char* id : {"2.2", "3.1", "3.2", "3.3", "3.4", "8.3", "8.4", "9.15"}) {
    const std::size_t at = all.points.find(std::string("\n") + id + ",") + 1;
    few.points += all.points.substr(at, all.points.find('\n', at) - at) + "\n";
  }
  std::vector<std::string> notes;
  ASSERT_TRUE(read(few, &notes));
  EXPECT_THAT(notes, Contains(HasSubstr("open_jaw (2.1)")));
  const auto expect_error = [&](ObjHead files, const char* text) {
    const Result<Head> head = read(files);
    ASSERT_FALSE(head) << text;
    EXPECT_THAT(head.error().describe(), HasSubstr(text));
  };
  ObjHead wrong = few;
  wrong.points += "8.3,1\n";
  expect_error(wrong, "8.3 is given twice");
  wrong.points = few.points + "1.1,1\n";
  expect_error(wrong, "no feature point 1.1");
  wrong.points = few.points + "2.1,9999999\n";
  expect_error(wrong, "line 9: point 2.1");
  wrong.points = few.points.substr(few.points.find("8.3"));
  expect_error(wrong, "3.1 (centre of the upper inner left eyelid)");
  for (std::size_t at; (at = wrong.obj.find("_eye\n")) != std::string::npos;) {
    wrong.obj.replace(at, 4, "_hat");
  }
  expect_error(wrong, "the eyes were not found");
  wrong = few;
  const std::size_t at = wrong.points.find("8.3");
  wrong.points[at + 2] = '9';  // the corner of the mouth is called 8.9
  expect_error(wrong, "8.3");
}

TEST(ObjFile, TakesWhatPackagesWrite) {
  const char* text =
      "# a comment\r\nmtllib x.mtl\r\no Head Object\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\n"
      "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3//1 \\\n  4\n"
      "usemtl EyeLeft\nv 5 5 5 0.5 0.25 1\nf -1 -2 -3\n";
  const auto file = head::read_obj(text);
  ASSERT_TRUE(file) << file.error().describe();
  ASSERT_EQ(file->pieces.size(), 2u);
  EXPECT_EQ(file->pieces[0].name, "Head Object");
  EXPECT_EQ(file->pieces[0].mesh.triangles.size(), 2u);
  EXPECT_EQ(file->pieces[1].mesh.positions[0], (Vec3{5, 5, 5}));
  ASSERT_EQ(file->vertices.size(), 5u);
  EXPECT_EQ(file->vertices[4].piece, 1u);
  EXPECT_EQ(file->vertices[2].piece, 0u) << "the first face that has it";
}

TEST(ObjFile, ErrorsNameTheLine) {
  const auto expect_error = [](const char* text, const char* wanted) {
    const auto file = head::read_obj(text);
    ASSERT_FALSE(file) << text;
    EXPECT_THAT(file.error().describe(), HasSubstr(wanted));
  };
  expect_error("", "no face");
  expect_error("v 0 0 0\nv 1 x 0\n", "line 2:5: \"x\" is no number");
  expect_error("v 0 0\n", "needs x, y and z");
  expect_error("v 0 0 0\nf 1 1 2\n", "line 2:7: vertex 2 does not exist here; there are 1");
  expect_error("v 0 0 0\nf 1 1 0\n", "vertex 0");
  expect_error("v 0 0 0\nf 1 1\n", "three corners");
  expect_error("v nan 0 0\n", "no number");
}

TEST(ObjFile, HasLimits) {
  std::string vertices;
  for (int i = 0; i < 500'001; ++i) vertices += "v 0 0 0\n";
  const auto large = head::read_obj(vertices);
  ASSERT_FALSE(large);
  EXPECT_THAT(large.error().describe(), HasSubstr("line 500001"));
  EXPECT_THAT(large.error().message, HasSubstr("more than 500000 vertices"));
  std::string faces = "v 0 0 0\n";
  for (int i = 0; i < 3; ++i) {
    faces += "f";
    for (int k = 0; k < 700'000; ++k) faces += " 1";
    faces += "\n";
  }
  EXPECT_THAT(head::read_obj(faces).error().message, HasSubstr("more than 2000000 triangles"));
}

TEST(PointList, TakesTheUsualForms) {
  const auto with_heading = head::read_points(
      "\xEF\xBB\xBF"
      "Name;Feature Point;Vertex index (0-based)\r\nchin;2.1;966\r\n\r\nlip;2.2;7\r\n");
  ASSERT_TRUE(with_heading) << with_heading.error().describe();
  ASSERT_EQ(with_heading->size(), 2u);
  EXPECT_EQ((*with_heading)[1].id, "2.2");
  EXPECT_EQ((*with_heading)[1].vertex, 7u);
  const auto plain = head::read_points("2.1 966  # chin\n8.3   12\n");
  ASSERT_TRUE(plain);
  EXPECT_EQ((*plain)[1].vertex, 12u);
  const auto places = head::read_points("id,x,y,z\n2.1,0,-7.5,10\n");
  ASSERT_TRUE(places);
  EXPECT_EQ((*places)[0].place, (Vec3{0, -7.5f, 10}));
  const auto expect_error = [](const char* text, const char* wanted) {
    const auto rows = head::read_points(text);
    ASSERT_FALSE(rows) << text;
    EXPECT_THAT(rows.error().describe(), HasSubstr(wanted));
  };
  expect_error("\n# nothing\n", "has no point");
  expect_error("2.1,966\n2.2,x\n", "line 2: \"x\" is no vertex number");
  expect_error("2.1,1,nan,3\n", "line 1: point 2.1 needs a vertex number, or x, y and z");
  expect_error("2.1\n", "needs a vertex number");
  expect_error("vertex,x\n1,2\n", "no column feature_point");
  std::string many;
  for (int i = 0; i < 10'001; ++i) many += "2.1 0\n";
  expect_error(many.c_str(), "line 10001: the list has more than 10000 points");
}

// A head of other people, with the list of its landmarks.
TEST(OwnHead, OfIctFaceKitMovesAsTheTableSays) {
  const std::string dir = shared_dir().string();
  if (dir.empty()) GTEST_SKIP() << "no reference data (ANIMEME_SHARED)";
  const std::string folder = dir + "/data/ict_facekit/";
  ObjHead files{test::run("gzip -dc '" + folder + "generic_neutral_mesh.obj.gz'"),
                test::run("cat '" + folder + "ict_feature_points.csv'")};
  std::vector<std::string> notes;
  const Result<Head> head = read(files, &notes);
  ASSERT_TRUE(head) << head.error().describe();
  EXPECT_NEAR(head->fapu.es, 5.9025, 0.001);
  EXPECT_NEAR(head->fapu.mw, 5.0698, 0.001);
  EXPECT_GT(head->part(Part::left_eye).triangles.size(), 500u);
  EXPECT_GT(head->part(Part::upper_teeth).triangles.size(), 500u);
  EXPECT_GT(head->part(Part::lower_teeth).triangles.size(), 500u);
  EXPECT_GT(expect_table_moves(*head, head::make_rig(*head), {300}, Part::skin), 40);
}

}  // namespace own_head_test
}  // namespace animeme::test
