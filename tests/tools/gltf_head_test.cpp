// Heads of users from glTF files, run as a user does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/png_reader.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"

namespace animeme {
namespace gltf_head_test {

using test::animeme;
using test::slurp;
using test::TempDir;
using ::testing::HasSubstr;

std::string clip() { return (test::data_dir() / "fap" / "plain.fap").string(); }

// The built-in child as somebody else's head.
std::string child(const TempDir& dir) {
  const auto made = animeme({"export", clip(), "--head", "child", "-o", dir / "anna.glb"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  return dir / "anna.glb";
}

test::Bytes picture(const TempDir& dir, const std::string& head) {
  const auto made = animeme({"render", "--shapes", "expressions", "--size", "96x96", "--head", head,
                             "-o", dir / "out.png"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const std::string file = slurp(dir / "out.png");
  int width = 0, height = 0;
  return test::decode_png(test::Bytes(file.begin(), file.end()), width, height);
}

TEST(GltfHead, LooksLikeTheOneThatWasExported) {
  const TempDir dir;
  const test::Bytes was = picture(dir, "child");
  const test::Bytes is = picture(dir, child(dir));
  const test::Bytes other = picture(dir, "man");
  ASSERT_EQ(is.size(), was.size());
  ASSERT_EQ(other.size(), was.size());
  double off = 0, far = 0;
  for (std::size_t i = 0; i < is.size(); ++i) {
    off += std::abs(int(is[i]) - int(was[i]));
    far += std::abs(int(other[i]) - int(was[i]));
  }
  EXPECT_LT(off, 0.75 * far);  // the camera stands a little elsewhere
}

TEST(GltfHead, IsExportedAgainWithItsOwnShapes) {
  const TempDir dir;
  const auto made = animeme({"export", clip(), "--head", child(dir), "-o", dir / "again.glb"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("head \"anna\""));
  EXPECT_THAT(slurp(dir / "again.glb"), HasSubstr("\"mouthSmileLeft\""));
}

TEST(GltfHead, IsSeenInAPage) {
  const TempDir dir;
  const auto made = animeme({"view", clip(), "--head", child(dir), "-o", dir / "anna.html"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_GT(slurp(dir / "anna.html").size(), 300'000u);
}

TEST(GltfHead, MistakesAreNamed) {
  const TempDir dir;
  const std::string head = child(dir);
  test::spill(dir / "points.csv", "feature_point,vertex\n2.1,99999999\n");
  const auto points = animeme(
      {"render", clip(), "--head", head, "--points", dir / "points.csv", "-o", dir / "x.png"});
  EXPECT_EQ(points.exit_code, 3) << points.err;
  EXPECT_THAT(points.err, HasSubstr("points.csv:2: point 2.1: there is no vertex 99999999"));
  const std::string whole = slurp(head);
  test::spill(dir / "cut.glb", whole.substr(0, whole.size() / 2));
  const auto cut = animeme({"render", clip(), "--head", dir / "cut.glb", "-o", dir / "x.png"});
  EXPECT_EQ(cut.exit_code, 3) << cut.err;
  EXPECT_THAT(cut.err, HasSubstr("cut.glb"));
  EXPECT_THAT(cut.err, HasSubstr("ends too early"));
}

}  // namespace gltf_head_test
}  // namespace animeme
