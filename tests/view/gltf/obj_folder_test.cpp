// Heads as folders of OBJ files.
#include "tools/view/gltf/obj_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "fap/arkit.h"
#include "fap/head/rig.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"
#include "tests/view/gltf/actor.h"
#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace obj_folder_test {

namespace fs = std::filesystem;
using head::Part;
using head::Vec3;
using test::TempDir;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kShapes[] = {"eyeBlink_L",  "eyeBlink_R",    "jawOpen",      "mouthClose",
                                   "mouthFunnel", "mouthPucker",   "mouthSmile_L", "mouthSmile_R",
                                   "browDown_L",  "mouthUpperUp_L"};

fap::Frame face(std::string_view shape) {
  fap::ArkitFrame weights{};
  weights[std::size_t(fap::find_arkit(shape).value_or(0))] = 1;
  return fap::arkit_to_fap(weights, fap::kAllArkit);
}

// The woman in a pose. Faces only where it is asked for: shapes of scanners often have none.
std::string obj_of(const fap::Frame& frame, bool faces) {
  const head::Rig& rig = actor().rig;
  const head::Pose pose = head::pose(rig, frame);
  std::string text = "# made for a test\n", triangles;
  std::size_t first = 1;
  char line[120];
  for (const Part part : {Part::skin, Part::left_eye, Part::right_eye, Part::lower_teeth}) {
    const auto p = std::size_t(part);
    const auto& places = pose.positions[p].empty() ? rig.parts[p].positions : pose.positions[p];
    for (const Vec3 at : places) {
      std::snprintf(line, sizeof line, "v %.6f %.6f\t%.6f\r\n", double(at.x), double(at.y),
                    double(at.z));
      text += line;
    }
    triangles += "usemtl " + std::string(head::kPartNames[p]) + "\n";
    for (const head::Triangle& t : rig.parts[p].triangles) {
      std::snprintf(line, sizeof line, "f %zu/1 %zu/1 %zu/1\n", first + t[0], first + t[1],
                    first + t[2]);
      triangles += line;
    }
    first += places.size();
  }
  return faces ? text + triangles : text + "vt 0 0\nvn 0 0 1\n";
}

std::string spelled(const char* shape) {  // as ARKit does
  std::string name = shape;
  if (name.ends_with("_L")) return name.substr(0, name.size() - 2) + "Left";
  if (name.ends_with("_R")) return name.substr(0, name.size() - 2) + "Right";
  return name;
}

void write_folder(const std::string& folder) {
  fs::create_directories(folder);
  test::spill(folder + "/generic_neutral_mesh.obj", obj_of({}, true));
  for (const char* shape : kShapes) {
    test::spill(folder + "/" + shape + ".obj", obj_of(face(spelled(shape)), false));
  }
  test::spill(folder + "/readme.txt", "no head\n");
  test::spill(folder + "/identity001.obj", "v 1 2 3\n");  // of another size: not looked at
}

std::vector<std::string> shapes_of(const head::Head& head) {
  std::vector<std::string> names;
  for (const head::ShapeControl& shape : head.shapes) names.push_back(shape.name);
  return names;
}

float opening(const head::Rig& rig, const fap::Frame& frame) {
  const head::Pose open = head::pose(rig, frame);
  float most = 0;
  for (std::size_t v = 0; v < open.positions[0].size(); ++v) {
    most = std::max(most, rig.parts[0].positions[v].y - open.positions[0][v].y);
  }
  return most / float(rig.fapu.es);
}

TEST(ObjFolder, MovesAsItsFilesDo) {
  const TempDir dir;
  write_folder(dir / "face");
  auto file = read_obj_folder(dir / "face");
  ASSERT_TRUE(file) << file.error().describe();
  EXPECT_EQ(file->source.name, "face");
  EXPECT_THAT(file->source.notes, Contains(HasSubstr("identity001")));
  EXPECT_THAT(file->source.notes, Contains(HasSubstr("generic_neutral_mesh")));
  EXPECT_THAT(file->source.notes, Contains(HasSubstr("does not have: eyeLookDownLeft")));
  std::vector<std::string> notes;
  const auto head = head::assemble(std::move(file->source), &notes);
  ASSERT_TRUE(head) << head.error().describe();
  EXPECT_EQ(shapes_of(*head).size(), std::size(kShapes));
  for (const Part part : {Part::skin, Part::left_eye, Part::right_eye, Part::lower_teeth}) {
    EXPECT_FALSE(head->part(part).positions.empty()) << head::kPartNames[std::size_t(part)];
  }
  const head::Rig rig = head::make_rig(*head);
  const float is = opening(rig, face("jawOpen"));
  EXPECT_NEAR(is, opening(actor().rig, face("jawOpen")), 0.1f * is);
  EXPECT_GT(is, 0.1f);
}

fap::Frame frame_of(std::initializer_list<std::pair<int, int>> values) {
  fap::Frame frame;
  for (const auto& [fap, value] : values) frame.set(fap, value);
  return frame;
}

float weight_of(const head::Rig& rig, const fap::Frame& frame, std::string_view name) {
  const head::ControlValues values = head::control_values(rig, frame);
  for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
    if (rig.shapes[i].name == name) return values[head::kFirstShape + i] / head::kFullShape;
  }
  return -1;
}

// Files may be called after FAPs, by name or number; what they do is measured.
TEST(ObjFolder, FilesMayBeCalledAfterFaps) {
  const TempDir dir;
  fs::create_directories(dir / "face");
  const auto write = [&](const std::string& name, const fap::Frame& frame) {
    test::spill(dir / "face" + ("/" + name + ".obj"), obj_of(frame, name == "neutral"));
  };
  const fap::Frame open = face("jawOpen");
  write("neutral", {});
  write("open_jaw", open);
  write("fap_53_stretch_l_cornerlip_o", frame_of({{6, 200}, {53, 200}}));
  write("FAP54", frame_of({{7, 200}, {54, 200}}));
  write("raise_l_cornerlip", frame_of({{12, 300}, {59, 300}}));
  write("raise_r_cornerlip", frame_of({{13, 300}, {60, 300}}));
  write("FAP19", frame_of({{19, 1024}}));
  write("close_t_r_eyelid", frame_of({{20, 1024}}));
  write("Fap33", frame_of({{33, 250}}));
  write("head_pitch", frame_of({{33, 10}}));
  auto file = read_obj_folder(dir / "face");
  ASSERT_TRUE(file) << file.error().describe();
  EXPECT_THAT(file->source.notes, Contains(HasSubstr("head_pitch")));
  const auto head = head::assemble(std::move(file->source), nullptr);
  ASSERT_TRUE(head) << head.error().describe();
  EXPECT_EQ(head->shapes.size(), 8u);
  const head::Rig rig = head::make_rig(*head);
  // Its unit is that of a nose whose place is guessed by few shapes.
  EXPECT_GT(opening(rig, open), 0.5f * opening(actor().rig, open));
  EXPECT_GT(weight_of(rig, frame_of({{33, 250}}), "Fap33"), 0.6f);
  const fap::Frame wink = frame_of({{19, 1024}});
  EXPECT_GT(weight_of(rig, wink, "FAP19"), 0.9f);
  EXPECT_LT(weight_of(rig, wink, "close_t_r_eyelid"), 0.1f);
  EXPECT_LT(weight_of(rig, wink, "open_jaw"), 0.05f);
  EXPECT_GT(weight_of(rig, frame_of({{12, 300}, {59, 300}}), "raise_l_cornerlip"), 0.6f);
  EXPECT_GT(weight_of(rig, frame_of({{7, 200}, {54, 200}}), "FAP54"), 0.6f);
}

TEST(ObjFolder, PackedFilesAreTheSame) {
  const TempDir dir;
  write_folder(dir / "plain");
  fs::copy(dir / "plain", dir / "packed");
  int status = 0;
  test::run("gzip " + test::quoted(dir / "packed") + "/*.obj", &status);
  if (status != 0) GTEST_SKIP() << "gzip is not installed";
  const auto plain = read_obj_folder(dir / "plain");
  const auto packed = read_obj_folder(dir / "packed/");
  ASSERT_TRUE(plain) << plain.error().describe();
  ASSERT_TRUE(packed) << packed.error().describe();
  EXPECT_EQ(packed->source.name, "packed");
  ASSERT_EQ(packed->source.targets.size(), plain->source.targets.size());
  for (std::size_t i = 0; i < plain->source.targets.size(); ++i) {
    EXPECT_EQ(packed->source.targets[i].vertices, plain->source.targets[i].vertices);
  }
  // Damage is named, wherever it is.
  const std::string file = dir / "packed/jawOpen.obj.gz";
  const std::string whole = test::slurp(file);
  for (const std::size_t size :
       {std::size_t(3), std::size_t(12), whole.size() / 2, whole.size() - 3}) {
    test::spill(file, whole.substr(0, size));
    const auto cut = read_obj_folder(dir / "packed");
    ASSERT_FALSE(cut) << size;
    EXPECT_THAT(cut.error().describe(), HasSubstr("jawOpen.obj.gz"));
  }
  const auto most = read_obj_text(dir / "packed/eyeBlink_L.obj.gz", 100'000);
  ASSERT_FALSE(most);
  EXPECT_EQ(most.error().code, Code::out_of_range);
}

TEST(ObjFolder, NamesOfItsOwnNeedRules) {
  const TempDir dir;
  write_folder(dir / "face");
  fs::rename(dir / "face/jawOpen.obj", dir / "face/pose_17.obj");
  const auto without = read_obj_folder(dir / "face");
  ASSERT_TRUE(without) << without.error().describe();
  EXPECT_THAT(without->unknown, Contains("pose_17"));
  const auto with = read_obj_folder(
      dir / "face",
      {.rules = {{"pose_17", "jawOpen"}, {"mouthSmile_R", "-"}, {"identity001", "-"}}});
  ASSERT_TRUE(with) << with.error().describe();
  std::vector<std::string> names;
  for (const head::ShapeControl& shape : with->source.shapes) names.push_back(shape.name);
  EXPECT_THAT(names, Contains("pose_17"));
  EXPECT_THAT(names, Not(Contains("mouthSmile_R")));
  const auto wrong = read_obj_folder(dir / "face", {.rules = {{"pose_18", "jawOpen"}}});
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Code::not_found);
  EXPECT_THAT(wrong.error().describe(), HasSubstr("pose_17"));
}

TEST(ObjFolder, MistakesAreNamed) {
  const TempDir dir;
  const auto expect = [&](Code code, const char* text) {
    const auto head = read_obj_folder(dir / "face");
    ASSERT_FALSE(head) << text;
    EXPECT_EQ(head.error().code, code) << head.error().describe();
    EXPECT_THAT(head.error().describe(), HasSubstr(text));
  };
  fs::create_directories(dir / "face");
  expect(Code::not_found, "there is no .obj");
  write_folder(dir / "face");
  test::spill(dir / "face/jawOpen.obj", obj_of({}, false) + "v 0 0 0\n");
  expect(Code::invalid_argument, "jawOpen.obj");
  test::spill(dir / "face/jawOpen.obj", "v 0 0\n");
  expect(Code::syntax, "jawOpen.obj:1");
  fs::remove(dir / "face/generic_neutral_mesh.obj");
  expect(Code::not_found, "call it neutral.obj");
}

// The ten shapes of ICT-FaceKit, as its makers give them away.
TEST(ObjFolder, IctFaceKit) {
  const fs::path folder = test::shared_dir() / "data" / "ict_facekit";
  if (test::shared_dir().empty() || !fs::exists(folder)) GTEST_SKIP() << "no reference data";
  auto file = read_obj_folder(folder.string());
  ASSERT_TRUE(file) << file.error().describe();
  EXPECT_EQ(file->source.shapes.size(), 10u);
  EXPECT_EQ(file->source.points.size(), 24u);
  const auto rows = head::read_points(test::slurp((folder / "ict_feature_points.csv").string()));
  ASSERT_TRUE(rows) << rows.error().describe();
  const auto points = points_on(*file, *rows);
  ASSERT_TRUE(points) << points.error().describe();
  // The list also says where its vertices are.
  std::istringstream list(test::slurp((folder / "ict_feature_points.csv").string()));
  std::size_t checked = 0;
  for (std::string row; std::getline(list, row);) {
    char id[10];
    int vertex = 0;
    Vec3 p;
    if (std::sscanf(row.c_str(), "%9[^,],%d,%f,%f,%f", id, &vertex, &p.x, &p.y, &p.z) != 5)
      continue;
    ASSERT_LT(checked, points->size());
    const head::PiecePoint& point = (*points)[checked++];
    EXPECT_EQ(point.id, id);
    const Vec3 at = file->source.pieces[point.piece].mesh.positions[point.vertex];
    EXPECT_LT(head::length(at - p), 0.001f) << id;
  }
  EXPECT_EQ(checked, points->size());
  std::vector<std::string> notes;
  const auto head = head::assemble(std::move(file->source), &notes);
  ASSERT_TRUE(head) << head.error().describe();
  EXPECT_FALSE(head->part(Part::left_eye).positions.empty());
  EXPECT_FALSE(head->part(Part::lower_teeth).positions.empty());
}

}  // namespace obj_folder_test
}  // namespace animeme::gltf
