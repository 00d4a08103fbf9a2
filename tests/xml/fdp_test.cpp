// Xface files: our heads written and read again, files by hand, and what is refused.
#include "fap/xml/fdp.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "fap/xml/xmt.h"
#include "tests/head/head_support.h"
#include "tests/support/files.h"
#include "tests/xml/fdp_measure.h"

namespace animeme::test {
namespace fdp_test {

using head::FdpFiles;
using head::Head;
using head::LoadMeshFile;
using head::Part;
using head::Rig;
using head::Source;
using head::Vec3;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const FdpFiles& files_of(const std::string& name) {
  static std::map<std::string, FdpFiles> made;
  auto found = made.find(name);
  if (found == made.end()) {
    auto files = head::write_fdp(head_of(name), rig_of(name), {.name = name});
    EXPECT_TRUE(files) << files.error().describe();
    found = made.emplace(name, std::move(*files)).first;
  }
  return found->second;
}

LoadMeshFile only(const std::string& name, const std::string& content) {
  return [=](const std::string& wanted) -> Result<std::string> {
    if (wanted != name) return make_error(Code::not_found, "there is no file " + wanted);
    return content;
  };
}

class FdpHead : public ::testing::TestWithParam<std::string> {
 protected:
  const Head& head() const { return head_of(GetParam()); }
  const Rig& rig() const { return rig_of(GetParam()); }
  const Head& again() const {
    static std::map<std::string, Head> heads;
    auto found = heads.find(GetParam());
    if (found == heads.end()) {
      const FdpFiles& files = files_of(GetParam());
      auto source = head::read_fdp(files.fdp, only(GetParam() + ".wrl", files.wrl));
      EXPECT_TRUE(source) << source.error().describe();
      auto made = head::assemble(std::move(*source));
      EXPECT_TRUE(made) << made.error().describe();
      found = heads.emplace(GetParam(), std::move(*made)).first;
    }
    return found->second;
  }
};
INSTANTIATE_TEST_SUITE_P(Heads, FdpHead, ::testing::Values("woman", "child"));

TEST_P(FdpHead, MeshesAndPointsComeBack) {
  const Head& back = again();
  // The origin of another head is found from its eyes; ours may be a little elsewhere.
  const Vec3 shift = back.part(Part::skin).positions[0] - head().part(Part::skin).positions[0];
  EXPECT_LT(length(shift), 1);
  for (std::size_t p = 0; p < head::kPartCount; ++p) {
    const head::Mesh& was = head().parts[p];
    const head::Mesh& is = back.parts[p];
    ASSERT_EQ(is.positions.size(), was.positions.size()) << head::kPartNames[p];
    EXPECT_EQ(is.triangles, was.triangles) << head::kPartNames[p];
    for (std::size_t v = 0; v < is.positions.size(); ++v) {
      ASSERT_LT(length(is.positions[v] - was.positions[v] - shift), 1e-4f) << head::kPartNames[p];
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    EXPECT_LT(length(back.eyes[side].centre - head().eyes[side].centre - shift), 1e-4f);
  }
  EXPECT_NEAR(back.fapu.mns, head().fapu.mns, 1e-5);
  EXPECT_NEAR(back.fapu.irisd, head().fapu.irisd, 1e-5);
  for (std::size_t i = 0; i < fap::kFeaturePoints.size(); ++i) {
    EXPECT_EQ(back.feature_points[i].exists(), head().feature_points[i].exists())
        << fap::kFeaturePoints[i].id;
    EXPECT_EQ(back.feature_points[i].vertex, head().feature_points[i].vertex)
        << fap::kFeaturePoints[i].id;
    EXPECT_EQ(back.feature_points[i].part, head().feature_points[i].part)
        << fap::kFeaturePoints[i].id;
  }
}

TEST_P(FdpHead, EachFapMovesItsPointAsFarAsTheTableSays) {
  const Head& back = again();
  const Rig moved = head::make_rig(back);
  EXPECT_GT(expect_table_moves(back, moved, {400, -300}), 100);
  // The lower lip stays where it is when the upper one moves, and the other way round.
  for (const auto& [fap, other] : {std::pair(4, "2.3"), {5, "2.2"}, {51, "8.2"}, {52, "8.1"}}) {
    fap::Frame frame;
    frame.set(fap, 500);
    const Vec3 d =
        posed(back, moved, head::pose(moved, frame, {.contact = false}), other) - back.at(other);
    EXPECT_LT(length(d), 0.02 * fap::displacement(fap, 500, back.fapu)) << "FAP " << fap;
  }
}

// As Xface itself does it with the files: raised cosines on the vertex of the point.
TEST_P(FdpHead, InXfaceFiftySixFapsMoveTheirPointsWithinTwoPerCent) {
  const FdpFiles& files = files_of(GetParam());
  const auto file = head::detail::load_fdp(files.fdp, only(GetParam() + ".wrl", files.wrl));
  ASSERT_TRUE(file) << file.error().describe();
  int shown = 0;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const fap::Move move = fap::move_of(fap);
    const double step = head::detail::xface_step(fap, file->fapu);
    // Eyeballs come out as their pupils do.
    const std::string_view id = fap == 27   ? "3.5"
                                : fap == 28 ? "3.6"
                                            : fap::info(fap).feature_point;
    const auto item = std::find_if(file->items.begin(), file->items.end(),
                                   [&](const auto& each) { return each.name == id; });
    if (move.kind != fap::MoveKind::translate || step == 0 || item == file->items.end()) continue;
    head::detail::XfaceMesh mesh(file->meshes[item->mesh].positions);
    for (const auto& other : file->items) {
      if (other.mesh == item->mesh) mesh.add(other);
    }
    const Vec3 moved =
        head::detail::xface_direction(fap) * float(mesh.factors(fap)[item->pivot] * step * 1024);
    const double along = move.axis[0] * moved.x + move.axis[1] * moved.y + move.axis[2] * moved.z;
    const double wanted = fap::displacement(fap, 1024, file->fapu);
    EXPECT_NEAR(along, wanted, 0.02 * std::abs(wanted)) << "FAP " << fap;
    ++shown;
  }
  EXPECT_EQ(shown, 56);
}

// What the README says of the default number of regions.
TEST_P(FdpHead, RaisedCosinesComeNearToOurRig) {
  const auto measure = measure_fdp(rig(), files_of(GetParam()), head::FdpOptions().scale);
  ASSERT_TRUE(measure) << measure.error().describe();
  EXPECT_EQ(measure->lost, 0u);
  EXPECT_LE(measure->most_influences, 8u);
  EXPECT_GT(measure->all.move, 0.3);
  EXPECT_LT(measure->all.rms, 0.15 * measure->all.move);
  EXPECT_LT(measure->groups[7].rms, 0.15 * measure->groups[7].move);  // outer lip
}

// Xface turns eyeballs by so little that nobody sees it; so the pupils are shifted as well.
TEST_P(FdpHead, PupilsFollowTheGaze) {
  const FdpFiles& files = files_of(GetParam());
  const auto file = head::detail::load_fdp(
      files.fdp, [&](const std::string&) -> Result<std::string> { return files.wrl; });
  ASSERT_TRUE(file) << file.error().describe();
  for (const int fap : {23, 24, 25, 26}) {
    const std::string id = fap % 2 == 1 ? "3.5" : "3.6";
    const auto item = std::find_if(file->items.begin(), file->items.end(),
                                   [&](const head::detail::XfaceItem& i) { return i.name == id; });
    ASSERT_NE(item, file->items.end());
    head::detail::XfaceMesh mesh(file->meshes[item->mesh].positions);
    for (const auto& other : file->items) {
      if (other.mesh == item->mesh) mesh.add(other);
    }
    constexpr int kTurn = 20000;  // 0.2 rad
    const float factor = mesh.factors(fap)[item->pivot] *
                         float(head::detail::xface_step(fap, file->fapu) * kTurn) /
                         float(head::FdpOptions().scale);
    const Vec3 theirs = head::detail::xface_direction(fap) * factor;
    fap::Frame frame;
    frame.set(fap, kTurn);
    Vec3 ours = posed(head(), rig(), head::pose(rig(), frame), id) - head().at(id);
    ours.z = 0;
    EXPECT_GT(length(ours), 0.2f);
    EXPECT_LT(length(ours - theirs), 0.05f * length(ours)) << fap;
  }
}

TEST(FdpWrite, OneRegionForEachFapIsPossible) {
  const auto files = head::write_fdp(head_of("man"), rig_of("man"), {.name = "m", .regions = 1});
  ASSERT_TRUE(files);
  const auto measure = measure_fdp(rig_of("man"), *files, 10);
  ASSERT_TRUE(measure) << measure.error().describe();
  EXPECT_LT(measure->regions, 130u);
  EXPECT_LT(measure->all.rms, 0.35 * measure->all.move);
}

// A face that knows few points and has no eyes is a face, too.
TEST(FdpWrite, FewPointsAndPartsAreEnough) {
  Head few = head_of("child");
  for (std::size_t i = 0; i < fap::kFeaturePoints.size(); ++i) {
    constexpr std::string_view kKnown[] = {"2.1", "2.2", "2.3", "3.1", "3.2", "8.3", "8.4", "9.15"};
    const bool known = std::find(std::begin(kKnown), std::end(kKnown), fap::kFeaturePoints[i].id) !=
                       std::end(kKnown);
    if (!known) few.feature_points[i] = {};
  }
  for (const Part part : {Part::left_eye, Part::right_eye, Part::tongue, Part::brows}) {
    few.part(part) = {};
  }
  const Rig rig = head::make_rig(few);
  const auto files = head::write_fdp(few, rig, {.name = "few"});
  ASSERT_TRUE(files) << files.error().describe();
  const auto source = head::read_fdp(files->fdp, only("few.wrl", files->wrl));
  ASSERT_TRUE(source) << source.error().describe();
  EXPECT_THAT(source->points, SizeIs(8));
  const auto head = head::assemble(*source);
  ASSERT_TRUE(head) << head.error().describe();
  // An XMT needs the points for all FAPU; the lower lid is missing.
  const auto no_scene = head::write_xmt(few, rig);
  ASSERT_FALSE(no_scene);
  EXPECT_THAT(no_scene.error().message, HasSubstr("3.3"));
  for (std::size_t i = 0; i < fap::kFeaturePoints.size(); ++i) {
    if (fap::kFeaturePoints[i].id == "3.3") few.feature_points[i] = head_of("child").point("3.3");
  }
  const auto scene = head::write_xmt(few, rig);
  ASSERT_TRUE(scene) << scene.error().describe();
  const auto again = head::read_xmt(*scene);
  ASSERT_TRUE(again) << again.error().describe();
  EXPECT_THAT(again->points, SizeIs(9));
}

TEST(FdpWrite, SameBytesEachTime) {
  const auto again = head::write_fdp(head_of("child"), rig_of("child"), {.name = "child"});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->fdp, files_of("child").fdp);
  EXPECT_EQ(again->wrl, files_of("child").wrl);
}

TEST(FdpWrite, SaysWhyItCannot) {
  Head bare = head_of("child");
  bare.feature_points.fill({});
  const auto no_points = head::write_fdp(bare, rig_of("child"));
  ASSERT_FALSE(no_points);
  EXPECT_THAT(no_points.error().message, HasSubstr("no feature points"));
  EXPECT_FALSE(head::write_fdp(head_of("child"), rig_of("man")));
  EXPECT_FALSE(head::write_fdp(head_of("child"), rig_of("child"), {.name = "../x"}));
  EXPECT_FALSE(head::write_fdp(head_of("child"), rig_of("child"), {.scale = 0}));
  Head fine = head_of("child");
  fine.part(Part::hair).positions.resize(70000);
  Rig rig = rig_of("child");
  rig.parts[std::size_t(Part::hair)].positions.resize(70000);
  EXPECT_EQ(head::write_fdp(fine, rig).error().code, Code::out_of_range);
}

}  // namespace fdp_test
}  // namespace animeme::test
