// A head of others with its shapes, as a .glb: ICT-FaceKit, where the reference data is.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "fap/fapu.h"
#include "fap/head/rig.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {
namespace ict_head_test {

using head::Vec3;
namespace fs = std::filesystem;

std::string unpacked(const fs::path& file) {
  std::string text;
  FILE* pipe = ::popen(("gzip -dc " + test::quoted(file.string())).c_str(), "r");
  if (pipe == nullptr) return text;
  char block[65536];
  for (std::size_t n = 0; (n = std::fread(block, 1, sizeof block, pipe)) > 0;) {
    text.append(block, n);
  }
  ::pclose(pipe);
  return text;
}

struct Obj {
  std::vector<float> places;
  std::map<std::string, std::vector<std::uint32_t>> triangles;  // by material
};

Obj read_obj(const fs::path& file) {
  Obj obj;
  std::string material;
  std::istringstream in(unpacked(file));
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "usemtl") words >> material;
    if (kind == "v") {
      for (int i = 0; i < 3; ++i) {
        float value = 0;
        words >> value;
        obj.places.push_back(value);
      }
    }
    if (kind != "f") continue;
    std::vector<std::uint32_t> corners;
    for (std::string corner; words >> corner;) {
      corners.push_back(std::uint32_t(std::stoul(corner)) - 1);
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      auto& out = obj.triangles[material];
      out.insert(out.end(), {corners[0], corners[i], corners[i + 1]});
    }
  }
  return obj;
}

const std::vector<std::string> kShapes = {
    "browInnerUp_L", "browInnerUp_R", "eyeBlink_L",  "eyeBlink_R",   "jawOpen",
    "mouthClose",    "mouthFunnel",   "mouthPucker", "mouthSmile_L", "mouthSmile_R"};

std::vector<std::uint8_t> ict_glb(const fs::path& folder) {
  const Obj neutral = read_obj(folder / "generic_neutral_mesh.obj.gz");
  test::GltfWriter file;
  const int places = file.accessor(neutral.places, "VEC3");
  nlohmann::json targets = nlohmann::json::array();
  for (const std::string& shape : kShapes) {
    const Obj moved = read_obj(folder / (shape + ".obj.gz"));
    std::vector<std::uint32_t> where;
    std::vector<float> moves;
    for (std::size_t v = 0; v * 3 < neutral.places.size(); ++v) {
      bool moves_here = false;
      for (std::size_t c = 0; c < 3; ++c) {
        moves_here = moves_here || moved.places[3 * v + c] != neutral.places[3 * v + c];
      }
      if (!moves_here) continue;
      where.push_back(std::uint32_t(v));
      for (std::size_t c = 0; c < 3; ++c) {
        moves.push_back(moved.places[3 * v + c] - neutral.places[3 * v + c]);
      }
    }
    targets.push_back({{"POSITION", file.sparse(neutral.places.size() / 3, where, moves, "VEC3")}});
  }
  nlohmann::json primitives = nlohmann::json::array();
  for (const auto& [material, corners] : neutral.triangles) {
    primitives.push_back({{"attributes", {{"POSITION", places}}},
                          {"indices", file.accessor(corners, "SCALAR")},
                          {"material", file.add("materials", {{"name", material}})},
                          {"targets", targets}});
  }
  file.add("meshes", {{"primitives", primitives}, {"extras", {{"targetNames", kShapes}}}});
  file.add("nodes", {{"mesh", 0}, {"name", "ict"}});
  file.add("scenes", {{"nodes", {0}}});
  return file.glb();
}

std::map<std::string, Vec3> listed_points(const fs::path& folder) {
  std::map<std::string, Vec3> listed;
  std::istringstream rows(test::slurp(folder / "ict_feature_points.csv"));
  for (std::string row; std::getline(rows, row);) {
    char id[10];
    int vertex = 0;
    Vec3 p;
    if (std::sscanf(row.c_str(), "%9[^,],%d,%f,%f,%f", id, &vertex, &p.x, &p.y, &p.z) == 5) {
      listed[id] = p;
    }
  }
  return listed;
}

TEST(IctHead, PointsOfShapesAreNearThoseOfTheList) {
  const fs::path folder = test::shared_dir() / "data" / "ict_facekit";
  if (test::shared_dir().empty() || !fs::exists(folder)) GTEST_SKIP() << "no reference data";
  const auto source = read_head(ict_glb(folder));
  ASSERT_TRUE(source) << source.error().describe();
  const std::map<std::string, Vec3> listed = listed_points(folder);
  EXPECT_EQ(source->points.size(), 24u);
  double squares = 0;
  for (const head::PiecePoint& point : source->points) {
    ASSERT_TRUE(listed.count(point.id)) << point.id;
    const Vec3 is = source->pieces[point.piece].mesh.positions[point.vertex];
    const double off = 10 * double(head::length(is - listed.at(point.id)));  // mm
    squares += off * off;
    std::printf("%-5s off by %.1f mm\n", point.id.c_str(), off);
    // The brow's shape moves skin below the hairs most.
    EXPECT_LT(off, point.id[0] == '4' ? 9.0 : 3.5) << point.id;
  }
  std::printf("all   off by %.1f mm rms\n", std::sqrt(squares / double(source->points.size())));
}

TEST(IctHead, UnitsAreThoseOfTheListedPoints) {
  const fs::path folder = test::shared_dir() / "data" / "ict_facekit";
  if (test::shared_dir().empty() || !fs::exists(folder)) GTEST_SKIP() << "no reference data";
  auto source = read_head(ict_glb(folder));
  ASSERT_TRUE(source) << source.error().describe();
  std::vector<std::string> notes;
  const auto head = head::assemble(std::move(*source), &notes);
  ASSERT_TRUE(head) << head.error().describe();
  EXPECT_EQ(head->shapes.size(), kShapes.size());
  fap::FeaturePoints points;
  for (const auto& [id, p] : listed_points(folder)) points[id] = {p.x, p.y, p.z};
  const auto listed = fap::measure_fapu(points);
  ASSERT_TRUE(listed);
  const auto same = [](const char* name, double is, double wanted, double share) {
    std::printf("%s %.2f cm, of the list %.2f\n", name, is, wanted);
    EXPECT_NEAR(is, wanted, share * wanted) << name;
  };
  same("IRISD", head->fapu.irisd, listed->irisd, 0.1);
  same("ES", head->fapu.es, listed->es, 0.1);
  same("ENS", head->fapu.ens, listed->ens, 0.1);
  same("MNS", head->fapu.mns, listed->mns, 0.12);
  same("MW", head->fapu.mw, listed->mw, 0.05);
}

TEST(IctHead, ItSpeaks) {
  const fs::path folder = test::shared_dir() / "data" / "ict_facekit";
  if (test::shared_dir().empty() || !fs::exists(folder)) GTEST_SKIP() << "no reference data";
  auto source = read_head(ict_glb(folder));
  ASSERT_TRUE(source) << source.error().describe();
  const auto head = head::assemble(std::move(*source));
  ASSERT_TRUE(head) << head.error().describe();
  const head::Rig rig = head::make_rig(*head);
  fap::Frame frame;  // the mouth is open: aa
  frame.mask.set(1);
  frame.viseme = {10, 0, 63, false};
  const head::Pose open = head::pose(rig, frame);
  const auto move = [&](const char* id) {
    const head::FeaturePoint point = head->point(id);
    const auto part = std::size_t(point.part);
    return open.positions[part][point.vertex].y - rig.parts[part].positions[point.vertex].y;
  };
  EXPECT_LT(move("2.3"), -1.0f);  // cm
  EXPECT_LT(move("2.1"), -0.8f);
  EXPECT_NEAR(move("2.2"), 0.2f, 0.3f);
  EXPECT_NEAR(move("3.1"), 0.0f, 0.1f);
}

}  // namespace ict_head_test
}  // namespace animeme::gltf
