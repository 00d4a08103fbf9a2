// Heads of users from glTF files, run as a user does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

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

// FAP 2 beside lips, as text. `brows`: and brows at rest.
std::string moody_clip(const TempDir& dir, bool brows) {
  std::string mask, values = "1 63 0 0 0 0 200 -300";
  for (int fap = 1; fap <= 68; ++fap) {
    const bool brow = brows && fap >= 31 && fap <= 38;
    mask += fap == 2 || fap == 3 || fap == 5 || brow ? "1 " : "0 ";
    if (brow) values += " 0";
  }
  test::spill(dir / "moody.fap", "2.1 moody 25 1\n" + mask + "\n0 " + values + "\n");
  return dir / "moody.fap";
}

// A face that the maker of a head made for joy, here one that cannot be taken for ours.
TEST(GltfHead, ShowsFap2ByItsOwnFacesBesideLips) {
  const TempDir dir;
  const std::string head = child(dir);
  const auto drawn = [&](const std::string& path) {
    const auto made = animeme({"render", path, "--frame", "0", "--size", "96x96", "--head", head,
                               "--shape-name", "browOuterUpLeft=joy", "-o", dir / "out.png"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return slurp(dir / "out.png");
  };
  const auto expanded = [&](const std::string& path) {
    EXPECT_EQ(animeme({"decode", path, "--expand", "-o", dir / "low.fap"}).exit_code, 0);
    return dir / "low.fap";
  };
  const std::string moody = moody_clip(dir, false);
  EXPECT_NE(drawn(moody), drawn(expanded(moody)));
  // Brows that are coded win.
  const std::string brows = moody_clip(dir, true);
  EXPECT_EQ(drawn(brows), drawn(expanded(brows)));
}

TEST(GltfHead, KeepsItsFileWhenItIsExported) {
  const TempDir dir;
  const std::string head = child(dir);
  test::spill(dir / "voice.mp3", "ID3 voice");
  const auto made = animeme({"export", clip(), clip(), "--head", head, "--sound", dir / "voice.mp3",
                             "--sound", dir / "voice.mp3", "-o", dir / "again.vrm"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("animation \"plain 2\""));
  const std::string before = slurp(head), after = slurp(dir / "again.vrm");
  EXPECT_GT(after.size(), before.size());
  const auto binary = [](const std::string& file) {
    std::uint32_t size = 0;
    std::memcpy(&size, file.data() + 12, 4);
    return file.substr(28 + size);
  };
  EXPECT_EQ(binary(after).substr(0, binary(before).size()), binary(before));
  EXPECT_THAT(after, HasSubstr("ID3 voice"));
  EXPECT_EQ(picture(dir, dir / "again.vrm"), picture(dir, head));
}

TEST(GltfHead, ExportSaysWhatDoesNotFit) {
  const TempDir dir;
  const std::string head = child(dir);
  const auto expect = [&](const std::vector<std::string>& arguments, const std::string& text) {
    std::vector<std::string> all = {"export", clip()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto result = animeme(all);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
  };
  expect({"--head", head, "-o", dir / "x.gltf"}, "must end in .glb or .vrm");
  expect({"--head", "man", "-o", dir / "x.vrm"}, "must end in .glb for head man");
  expect({clip(), "--head", "man", "-o", dir / "x.glb"}, "several clips");
  expect({clip(), "--head", head, "--sound", "a.wav", "-o", dir / "x.glb"}, "one sound for each");
  expect({"--head", "man", "--sound", "a.wav", "-o", dir / "x.glb"}, "--sound");
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

// A file with names of its own, as long as those that it had.
void rename_shapes(const std::string& file, const std::string& output) {
  std::string bytes = slurp(file);
  for (const char* name : {"jawOpen", "mouth", "eye", "brow", "cheek", "nose", "tongue", "jaw"}) {
    const std::string from = '"' + std::string(name);
    const std::string to = "\"q" + std::string(from.size() - 2, 'x');
    for (std::size_t at = 0; (at = bytes.find(from, at)) != std::string::npos; ++at) {
      if (bytes.compare(at, 10, "\"mouth_bon") != 0) bytes.replace(at, to.size(), to);
    }
  }
  test::spill(output, bytes);
}

TEST(GltfHead, NamesOfShapesCanBeSaid) {
  const TempDir dir;
  const std::string known = child(dir), strange = dir / "strange.glb";
  rename_shapes(known, strange);
  const auto refused = animeme({"head", strange});
  EXPECT_THAT(refused.err + refused.out, HasSubstr("qxxxxxx"));
  std::string table = "shape,meaning\n";
  const std::string bytes = slurp(known);
  for (const char* name : {"mouthSmileLeft", "mouthSmileRight", "mouthClose", "eyeBlinkLeft",
                           "eyeBlinkRight", "mouthFunnel", "mouthPucker"}) {
    const std::string group = name[0] == 'e' ? "eye" : "mouth";
    table += 'q' + std::string(group.size() - 1, 'x') + std::string(name).substr(group.size()) +
             ',' + name + '\n';
  }
  test::spill(dir / "names.csv", table);
  const std::vector<std::string> rules = {"--shape-name", "qxxxxxx=jawOpen", "--shape-names",
                                          dir / "names.csv"};
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), rules.begin(), rules.end());
    return animeme(arguments);
  };
  const auto head = run({"head", strange});
  EXPECT_EQ(head.exit_code, 0) << head.err;
  EXPECT_THAT(head.out, HasSubstr("moved by 8 shapes"));
  // Every command that takes such a head knows them.
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"render", clip(), "--frame", "0", "--size", "64x64", "--head", strange, "-o",
            dir / "a.png"},
           {"view", clip(), "--head", strange, "-o", dir / "a.html"},
           {"export", clip(), "--head", strange, "-o", dir / "a.glb"}}) {
    const auto result = run(command);
    EXPECT_EQ(result.exit_code, 0) << command[0] << ": " << result.err;
  }
  const auto without = animeme({"export", clip(), "--head", strange, "-o", dir / "b.glb"});
  EXPECT_EQ(without.exit_code, 3) << without.err;
  EXPECT_THAT(without.err, HasSubstr("--shape-name"));
  const auto missing = animeme({"head", strange, "--shape-name", "mouth_x=jawOpen"});
  EXPECT_EQ(missing.exit_code, 3) << missing.err;
  EXPECT_THAT(missing.err, HasSubstr("there are: "));
  const auto wrong = animeme({"head", strange, "--shape-name", "qxxxxxx=wurst"});
  EXPECT_EQ(wrong.exit_code, 2) << wrong.err;
  EXPECT_THAT(wrong.err, HasSubstr("\"wurst\" is not a known meaning"));
  const auto built_in = animeme({"head", "woman", "--shape-name", "a=jawOpen"});
  EXPECT_EQ(built_in.exit_code, 2) << built_in.err;
}

}  // namespace gltf_head_test
}  // namespace animeme
