// What programs of others make of our glTF files: the Khronos validator and Blender.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "fap/arkit.h"
#include "fap/head/own_head.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tools/view/gltf/glb.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {
namespace readers_test {

using nlohmann::json;
using test::has_program;
using test::quoted;
using test::run;
using test::TempDir;
namespace fs = std::filesystem;

const fs::path kHere = fs::path(test::kSourceFolder) / "tests" / "view" / "gltf" / "scripts";

// Five frames of a mouth that opens while the head turns.
std::string write_talk(const TempDir& dir, const GlbOptions& options) {
  fap::Sequence clip{{25, 1}, {}, "x"};
  for (int i = 0; i < 5; ++i) {
    fap::ArkitFrame weights{};
    weights[std::size_t(*fap::find_arkit("jawOpen"))] = 0.15 * i;
    weights[std::size_t(*fap::find_arkit("eyeBlinkLeft"))] = 0.2 * i;
    fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
    frame.number = i;
    frame.set(49, 5000 * i);
    clip.frames.push_back(frame);
  }
  const auto head = head::make_head(*head::head_parameters("child"));
  EXPECT_TRUE(head);
  const auto file = make_glb(*head, head::make_rig(*head), clip, options);
  EXPECT_TRUE(file);
  test::spill(dir / "talk.glb", std::string(file->begin(), file->end()));
  return dir / "talk.glb";
}

TEST(GlbReaders, TheValidatorFindsNothing) {
  if (!has_program("node")) GTEST_SKIP() << "node is not installed (Debian package nodejs)";
  if (!fs::exists(fs::path(test::kSourceFolder) / "tests/readers/js/node_modules/gltf-validator")) {
    GTEST_SKIP() << "npm gltf-validator is not installed: tools/setup.sh tests";
  }
  for (const GlbOptions& options :
       {GlbOptions{}, GlbOptions{.morphs = MorphNames::fap, .normals = true}}) {
    const TempDir dir;
    const std::string path = write_talk(dir, options);
    const json report =
        json::parse(run("node " + quoted((kHere / "validate.js").string()) + " " + quoted(path)),
                    nullptr, false);
    ASSERT_TRUE(report.is_object());
    EXPECT_EQ(report["issues"]["numErrors"], 0) << report["issues"].dump(1).substr(0, 2000);
    EXPECT_EQ(report["issues"]["numWarnings"], 0) << report["issues"].dump(1).substr(0, 2000);
    EXPECT_EQ(report["info"]["animationCount"], 1);
    EXPECT_EQ(report["info"]["hasMorphTargets"], true);
    EXPECT_EQ(report["info"]["hasSkins"], true);
  }
}

TEST(GlbReaders, BlenderHasTheTargetsAndTheKeys) {
  if (!has_program("blender")) GTEST_SKIP() << "Blender is not installed (Debian package blender)";
  const TempDir dir;
  const std::string path = write_talk(dir, {});
  const std::string text =
      run("blender --background --factory-startup --python " +
          quoted((kHere / "blender.py").string()) + " -- " + quoted(path) + " 2>/dev/null");
  const std::size_t at = text.find("REPORT ");
  ASSERT_NE(at, std::string::npos) << text.substr(0, 2000);
  const json report = json::parse(text.substr(at + 7, text.find('\n', at) - at - 7));
  json keys;  // of the face, which Blender may have given another name
  for (const json& object : report["objects"]) {
    if (object["type"] == "MESH" && object["shape_keys"].size() > keys.size()) {
      keys = object["shape_keys"];
    }
  }
  for (const char* name : {"Basis", "jawOpen", "eyeBlinkLeft", "mouthPucker", "browInnerUp"}) {
    EXPECT_NE(std::find(keys.begin(), keys.end(), name), keys.end()) << name;
  }
  bool jaw_keys = false;
  bool bone_keys = false;
  for (const auto& [action, curves] : report["actions"].items()) {
    for (const auto& [curve, count] : curves.items()) {
      if (curve == "key_blocks[\"jawOpen\"].value") {
        jaw_keys = true;
        EXPECT_EQ(count, 5);
      }
      bone_keys = bone_keys || curve.find("neck") != std::string::npos;
    }
  }
  EXPECT_TRUE(jaw_keys) << report["actions"].dump(1).substr(0, 2000);
  EXPECT_TRUE(bone_keys) << report["actions"].dump(1).substr(0, 2000);
}

// Blender writes what it has read of our file; that is read as a head of somebody else.
TEST(GlbReaders, AHeadThatWentThroughBlenderMovesAsBefore) {
  if (!has_program("blender")) GTEST_SKIP() << "Blender is not installed (Debian package blender)";
  const TempDir dir;
  head::HeadParameters parameters = *head::head_parameters("child");
  parameters.density = 0.5;
  const head::Head original = *head::make_head(parameters);
  const head::Rig rig = head::make_rig(original);
  fap::Sequence still{{25, 1}, {fap::Frame{}}, "still"};
  const auto file = make_glb(original, rig, still);
  ASSERT_TRUE(file);
  test::spill(dir / "in.glb", std::string(file->begin(), file->end()));
  const std::string said = run("blender --background --factory-startup --python " +
                               quoted((kHere / "blender_again.py").string()) + " -- " +
                               quoted(dir / "in.glb") + " " + quoted(dir / "out.glb") + " 2>&1");
  ASSERT_TRUE(fs::exists(dir / "out.glb")) << said.substr(0, 2000);
  auto source = read_head_file(dir / "out.glb");
  ASSERT_TRUE(source) << source.error().describe();
  const auto head = head::assemble(std::move(*source));
  ASSERT_TRUE(head) << head.error().describe();
  const head::Rig copy = head::make_rig(*head);
  EXPECT_EQ(copy.shapes.size(), 52u);
  for (std::size_t part = 0; part < rig.parts.size(); ++part) {
    EXPECT_EQ(copy.parts[part].positions.size(), rig.parts[part].positions.size())
        << head::kPartNames[part];
  }
  const head::Vec3 shift = copy.eyes[0].centre - rig.eyes[0].centre;
  double worst = 0;
  for (const char* name : {"jawOpen", "mouthPucker", "mouthSmileLeft", "eyeBlinkRight"}) {
    fap::ArkitFrame weights{};
    weights[std::size_t(*fap::find_arkit(name))] = 0.7;
    fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
    frame.set(49, 20000);
    const head::Pose is = head::pose(copy, frame), was = head::pose(rig, frame);
    for (std::size_t v = 0; v < is.positions[0].size(); ++v) {
      const head::Vec3 off = is.positions[0][v] - shift - was.positions[0][v];
      worst = std::max(worst, double(head::length(off)) * 10);
    }
  }
  std::printf("through Blender: off by at most %.2f mm\n", worst);
  EXPECT_LT(worst, 4);  // lids slide, morph targets do not
}

}  // namespace readers_test
}  // namespace animeme::gltf
