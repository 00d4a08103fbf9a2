// rig.wasm of the tree moves heads as the program does, without a browser. ANIMEME_RIG_MODULE names
// another one to look at (rig_module_test.sh).
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "tests/readers/scripts.h"
#include "tests/support/folders.h"
#include "tests/view/viewer/page_support.h"
#include "tests/view/viewer/rigs.h"
#include "tools/view/viewer/rig/packed_rig.h"

namespace animeme::test {
namespace rig_module_test {

std::string module_file() {
  const char* other = std::getenv("ANIMEME_RIG_MODULE");
  return other != nullptr ? other
                          : std::string(test::kSourceFolder) + "/tools/view/viewer/rig/rig.wasm";
}

// What rig.js takes: values by FAP.
Json values_of(const fap::Frame& frame) {
  Json values = Json::object();
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    if (frame.mask.test(std::size_t(f))) values[std::to_string(f)] = frame.value[std::size_t(f)];
  }
  if (frame.mask.test(1)) {
    values["1"] = {{"select1", frame.viseme.select1},
                   {"select2", frame.viseme.select2},
                   {"blend", frame.viseme.blend}};
  }
  return values;
}

// Where the vertices of all parts are, in order.
std::vector<float> places_of(const head::Rig& rig, const fap::Frame& frame) {
  const head::Pose pose = head::pose(rig, frame);
  std::vector<float> places;
  for (std::size_t part = 0; part < rig.parts.size(); ++part) {
    const auto& points = rig.deforms[part] ? pose.positions[part] : rig.parts[part].positions;
    for (const head::Vec3& point : points) {
      const head::Vec3 at = pose.transforms[part](point);
      places.insert(places.end(), {at.x, at.y, at.z});
    }
  }
  return places;
}

// The largest distance of a coordinate from where the program puts it, cm, of each rig; the last
// entry counts all coordinates.
Json distances(const std::vector<head::Rig>& rigs, const std::vector<fap::Frame>& frames,
               const TempDir& dir) {
  Json task = {{"module", module_file()}, {"parts", head::kPartCount}, {"rigs", Json::array()}};
  for (const fap::Frame& frame : frames) task["frames"].push_back(values_of(frame));
  for (const head::Rig& rig : rigs) {
    const std::string name = dir.file(std::to_string(task["rigs"].size()));
    const std::vector<std::uint8_t> packed = viewer::detail::pack_rig(rig);
    write_bytes(name + ".rig", packed);
    Bytes places;
    for (const fap::Frame& frame : frames) {
      const auto all = places_of(*viewer::detail::unpack_rig(packed), frame);
      const std::size_t size = places.size();
      places.resize(size + all.size() * sizeof(float));
      std::memcpy(places.data() + size, all.data(), all.size() * sizeof(float));
    }
    write_bytes(name + ".places", places);
    task["rigs"].push_back(name);
  }
  spill(dir.file("task.json"), task.dump());
  return run_json("node '" + std::string(test::kSourceFolder) +
                  "/tests/view/viewer/js/rig_report.mjs' '" + dir.file("task.json") + "'");
}

TEST(RigModule, MovesHeadsAsTheProgramDoes) {
  if (!has_node()) GTEST_SKIP() << "node 18 or later is not installed (Debian package nodejs)";
  const TempDir dir;
  std::vector<fap::Frame> frames;
  for (unsigned seed = 1; seed < 7; ++seed) frames.push_back(random_frame(seed));
  for (unsigned seed = 1; seed < 4; ++seed) frames.push_back(mixed_frame(seed));
  const Json report =
      distances({small_rig(), shape_rig(), test_head().rig, foreign_head().rig}, frames, dir);
  ASSERT_EQ(report["distances"].size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(report["distances"][i].get<float>(), 0.0005f)
        << "rig " << i
        << ": the sources moved on; renew the module by tools/view/viewer/rig/make.sh";
    EXPECT_GT(report["moved"][i].get<float>(), 0.1f) << "rig " << i;
  }
  EXPECT_GT(report["coordinates"].get<int>(), 100000);
}

}  // namespace rig_module_test
}  // namespace animeme::test
