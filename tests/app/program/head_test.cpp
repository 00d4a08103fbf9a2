// `animeme head`, and heads of users in the other commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/files.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/png_reader.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"

namespace animeme {
namespace head_test {

using test::animeme;
using test::TempDir;
using testing::HasSubstr;
using Json = nlohmann::json;

Json described(std::vector<std::string> arguments, int exit_code = 0) {
  arguments.insert(arguments.begin(), {"head"});
  arguments.push_back("--json");
  const auto result = animeme(arguments);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  return Json::parse(result.out, nullptr, false);
}

// A head of ours, written and read as each kind of file that users have.
TEST(HeadCommand, WritesHeadsThatItReadsAgain) {
  const TempDir dir;
  const Json man = described({"man"});
  EXPECT_EQ(man["moved_by"], "feature_points");
  EXPECT_EQ(man["feature_points_cm"].size(), 83u);
  EXPECT_TRUE(man["missing_feature_points"].empty());
  const struct {
    std::string name;
    std::vector<std::string> more;
    const char* moved_by;
  } cases[] = {{"man.fdp", {}, "targets"},
               {"man.xmt", {}, "targets"},
               {"man.obj", {"--points", dir / "man.points.csv"}, "feature_points"},
               {"man.glb", {}, "shapes"}};
  for (const auto& test : cases) {
    const auto made = animeme({"head", "man", "-o", dir / test.name});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    std::vector<std::string> arguments = {dir / test.name};
    arguments.insert(arguments.end(), test.more.begin(), test.more.end());
    const Json head = described(arguments);
    EXPECT_EQ(head["moved_by"], test.moved_by) << test.name;
    EXPECT_NEAR(head["fapu_cm"]["ES"].get<double>(), man["fapu_cm"]["ES"].get<double>(), 0.1);
    for (const char* part : {"left_eye", "upper_teeth", "tongue", "hair"}) {
      const double wanted = man["parts"][part]["triangles"].get<double>();
      // Readers of glTF drop triangles without area.
      EXPECT_NEAR(head["parts"][part]["triangles"].get<double>(), wanted, 0.03 * wanted)
          << test.name << " " << part;
    }
    const Json& chin = head["feature_points_cm"]["2.1"];
    for (std::size_t axis = 0; axis < 3 && test.name != "man.glb"; ++axis) {
      EXPECT_NEAR(chin[axis].get<double>(), man["feature_points_cm"]["2.1"][axis].get<double>(),
                  0.02)
          << test.name;
    }
  }
}

TEST(HeadCommand, HeadsOfUsersAreDrawnShownAndExported) {
  const TempDir dir;
  ASSERT_EQ(animeme({"head", "child", "-o", dir / "me.obj"}).exit_code, 0);
  const std::string clip = (test::data_dir() / "grid_s1_sample/fap/prac8p.csv").string();
  const std::vector<std::string> own = {"--head", dir / "me.obj", "--points",
                                        dir / "me.points.csv"};
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), own.begin(), own.end());
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  run({"render", clip, "--time", "0.9", "--size", "80x80", "-o", dir / "me.png"});
  run({"view", clip, "-o", dir / "me.html"});
  run({"export", clip, "-o", dir / "me.glb"});
  EXPECT_GT(std::filesystem::file_size(dir / "me.png"), 2000u);
  EXPECT_GT(std::filesystem::file_size(dir / "me.html"), 300'000u);
  // What was exported moves by the shapes that it was given.
  const Json exported = described({dir / "me.glb"});
  EXPECT_EQ(exported["moved_by"], "shapes");
  EXPECT_THAT(exported["shapes"], testing::Contains("jawOpen"));
  const auto own_picture = test::slurp(dir / "me.png");
  run({"render", clip, "--time", "0", "--size", "80x80", "-o", dir / "rest.png"});
  EXPECT_NE(own_picture, test::slurp(dir / "rest.png"));
}

// What was measured of a sound.
Json row_of(const Json& table, const std::string& sound, const std::string& measure) {
  for (const Json& row : table["rows"]) {
    if (row["sound"] == sound && row["measure"] == measure) return row;
  }
  return {{"value", -1e9}};
}

// With the gain that fits the head all is well; as spoken, AA is less than half of a full jawOpen,
// and the command fails. IY is open, as recorded, about as far as AA.
TEST(HeadCommand, SpeakTestMeasuresLips) {
  for (const char* name : {"woman", "man", "child"}) {
    const Json table = described({name, "--speak-test"});
    ASSERT_EQ(table["rows"].size(), 22u) << name;
    for (const Json& row : table["rows"]) EXPECT_TRUE(row["ok"]) << name << row.dump();
    EXPECT_GT(table["gain"], 1.2) << name;
    const Json close = row_of(table, "IY", "lips apart, % of AA");
    EXPECT_NEAR(double(close["at_most"]), 120, 1e-9);
    EXPECT_GT(close["value"], 20) << name;
    const Json as_spoken = described({name, "--speak-test", "--gain", "1"}, 1);
    EXPECT_EQ(as_spoken["gain"], 1);
    EXPECT_LT(row_of(as_spoken, "AA", "open, % of a full opening")["value"], 50) << name;
  }
}

// Of other people's heads: by their own visemes, and by FAPs alone.
TEST(HeadCommand, SpeakTestOfAvatars) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "no reference data";
  const auto data = test::shared_dir() / "data";
  for (const char* name : {"avatars/arkit_and_visemes.glb", "avatars/brunette-t.glb",
                           "avatars/visemes_only.glb", "avatars/vroid.glb", "ict_facekit"}) {
    for (const char* mouth : {"visemes", "faps"}) {
      const Json table = described({(data / name).string(), "--speak-test", "--mouth", mouth});
      for (const Json& row : table["rows"]) EXPECT_TRUE(row["ok"]) << name << mouth << row.dump();
      EXPECT_GE(table["rows"].size(), 18u) << name;
    }
  }
  const std::string rpm = (data / "avatars/brunette-t.glb").string();
  const Json own = described({rpm, "--speak-test"});
  EXPECT_GT(row_of(own, "UW against IY", "mouth narrower, %")["value"], 25);
  EXPECT_GT(row_of(own, "W against IY", "mouth narrower, %")["value"], 15);
}

// A file that knows its phones shows them by an avatar's own visemes; one that does not, by FAPs.
TEST(HeadCommand, PhonesOfAFileAreShownByOwnVisemes) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "no reference data";
  const TempDir dir;
  const std::string head = (test::shared_dir() / "data/avatars/visemes_only.glb").string();
  std::ofstream(dir / "s.tsv") << "start_s\tend_s\tphone\n0\t0.3\tSIL\n0.3\t0.5\tAA\n"
                                  "0.5\t0.6\tF\n0.6\t0.9\tUW\n0.9\t1.2\tSIL\n";
  for (const char* out : {"s.mp4", "s.fba"}) {
    ASSERT_EQ(animeme({"speak", "--script", dir / "s.tsv", "-o", dir / out}).exit_code, 0);
  }
  const auto exported = [&](const std::string& clip, std::vector<std::string> more) {
    std::vector<std::string> all = {"export", dir / clip, "--head", head, "-o", dir / "o.glb"};
    all.insert(all.end(), more.begin(), more.end());
    const auto result = animeme(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return test::slurp(dir / "o.glb");
  };
  const std::string by_visemes = exported("s.mp4", {});
  const std::string by_faps = exported("s.mp4", {"--mouth", "faps"});
  EXPECT_TRUE(by_visemes != by_faps);
  // The name of the animation is that of the file without its ending.
  EXPECT_TRUE(exported("s.fba", {}) == by_faps);
  EXPECT_TRUE(exported("s.fba", {"--script", dir / "s.tsv"}) == by_visemes);
  // So is FAP 1 of a stream.
  ASSERT_EQ(
      animeme({"speak", "--script", dir / "s.tsv", "--visemes", "instead", "-o", dir / "one.fba"})
          .exit_code,
      0);
  EXPECT_TRUE(exported("one.fba", {}) != exported("one.fba", {"--mouth", "faps"}));
  const auto drawn = [&](const std::string& mouth) {
    EXPECT_EQ(animeme({"render", dir / "s.mp4", "--head", head, "--time", "0.56", "--size", "64x64",
                       "--zoom", "3", "--mouth", mouth, "-o", dir / "f.png"})
                  .exit_code,
              0);
    return test::slurp(dir / "f.png");
  };
  EXPECT_TRUE(drawn("visemes") != drawn("faps"));
}

TEST(HeadCommand, SpeakTestDrawsASheet) {
  const TempDir dir;
  ASSERT_EQ(animeme({"head", "child", "--speak-test", "-o", dir / "sheet.png"}).exit_code, 0);
  EXPECT_GT(test::slurp(dir / "sheet.png").size(), 50000u);
  EXPECT_EQ(animeme({"head", "child", "--speak-test", "-o", dir / "sheet.glb"}).exit_code, 2);
  EXPECT_EQ(animeme({"head", "child", "-o", dir / "child.png"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(dir / "child.png"));
}

// What has no face says so, and does not ask for eyes.
TEST(HeadCommand, AFileWithoutAFaceIsNamed) {
  const TempDir dir;
  test::GltfWriter file;
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const Json primitive = {{"attributes", {{"POSITION", file.accessor(corners, "VEC3")}}}};
  const int mesh = file.add("meshes", {{"primitives", Json::array({primitive})}});
  file.add("scenes", {{"nodes", Json::array({file.add("nodes", {{"mesh", mesh}})})}});
  test::write_bytes(dir / "chair.vrm", file.glb());
  const auto result = animeme({"head", dir / "chair.vrm"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("there is no face in it"));
}

// --gain moves what others draw: an avatar's file gets larger weights.
TEST(HeadCommand, AGainOpensAnAvatarsMouthWider) {
  const TempDir dir;
  const std::string me = dir / "me.glb", clip = dir / "clip.fap";
  ASSERT_EQ(animeme({"head", "child", "-o", me}).exit_code, 0);
  std::string mask = "0 0 1 0 1";
  for (int fap = 6; fap <= 68; ++fap) mask += " 0";
  std::ofstream(clip) << "2.1 clip 25 1\n" << mask << "\n0 200 -300\n";
  const auto exported = [&](const std::string& gain) {
    const std::string out = dir / ("talk" + gain + ".glb");
    EXPECT_EQ(animeme({"export", clip, "--head", me, "--gain", gain, "-o", out}).exit_code, 0);
    return test::slurp(out);
  };
  const std::string plain = exported("1");
  EXPECT_EQ(plain, [&] {
    const std::string out = dir / "plain.glb";
    EXPECT_EQ(animeme({"export", clip, "--head", me, "-o", out}).exit_code, 0);
    return test::slurp(out);
  }());
  EXPECT_NE(plain, exported("2"));
  EXPECT_NE(plain, exported("auto"));
  for (const char* bad : {"5", "0.1", "wide", "1x", ""}) {
    const auto result = animeme({"export", clip, "--head", me, "--gain", bad, "-o", dir / "x.glb"});
    EXPECT_EQ(result.exit_code, 2) << bad;
    EXPECT_THAT(result.err, HasSubstr("auto or a number from 0.25 to 4")) << bad;
  }
}

// Names of files need not be UTF-8; JSON is.
TEST(HeadCommand, JsonOfAHeadWithAnyName) {
  const TempDir dir;
  const std::string path = dir / "caf\xE9.glb";
  ASSERT_EQ(animeme({"head", "child", "-o", path}).exit_code, 0);
  for (const bool speak : {false, true}) {
    std::vector<std::string> all = {path};
    if (speak) all.push_back("--speak-test");
    EXPECT_EQ(described(all)["name"], "caf\uFFFD");
  }
}

// A mask that lacks a point of the lips cannot be measured: the point is named.
TEST(HeadCommand, SpeakTestNamesTheMissingPoint) {
  const auto result =
      animeme({"head", (test::data_dir() / "heads/mask.fdp").string(), "--speak-test"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("no feature point 2.3"));
  // Its motion is drawn all the same.
  const TempDir dir;
  const auto drawn =
      animeme({"render", "--shapes", "visemes", "--size", "40x40", "--gain", "auto", "--head",
               (test::data_dir() / "heads/mask.fdp").string(), "-o", dir / "mask.png"});
  EXPECT_EQ(drawn.exit_code, 0);
  EXPECT_THAT(drawn.err, HasSubstr("lips open without gain"));
}

// Xface cuts texts at blanks: the files that an .fdp names have none, wherever it lies.
TEST(HeadCommand, WritesXfaceHeadsWithTheirTextures) {
  const TempDir dir;
  std::filesystem::create_directory(dir / "two words");
  const std::filesystem::path folder = dir / "two words";
  const auto made = animeme({"head", "child", "-o", (folder / "my child.fdp").string()});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("10 textures"));
  EXPECT_TRUE(std::filesystem::exists(folder / "my_child_skin.tga"));
  const auto read = animeme({"head", (folder / "my child.fdp").string()});
  ASSERT_EQ(read.exit_code, 0) << read.err;
  EXPECT_THAT(read.out, testing::Not(HasSubstr("texture")));
  // Drawn, it looks as the head that it was.
  const std::string clip = (test::data_dir() / "grid_s1_sample/fap/prac8p.csv").string();
  const auto drawn = [&](const std::string& head) {
    const auto done = animeme({"render", clip, "--time", "0", "--size", "120x120", "--head", head,
                               "-o", dir / "drawn.png"});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    int width = 0;
    int height = 0;
    return test::decode_png(test::read_bytes(dir / "drawn.png"), width, height);
  };
  const test::Bytes own = drawn("child");
  const test::Bytes back = drawn((folder / "my child.fdp").string());
  ASSERT_EQ(own.size(), back.size());
  double sum = 0;
  for (std::size_t i = 0; i < own.size(); ++i) sum += std::abs(int(own[i]) - int(back[i]));
  EXPECT_LT(sum / double(own.size()), 6);  // it is 3; a head of plaster 29
  // Without a texture the colours in the mesh count.
  std::filesystem::remove(folder / "my_child_skin.tga");
  const auto without = animeme({"head", (folder / "my child.fdp").string()});
  ASSERT_EQ(without.exit_code, 0) << without.err;
  EXPECT_THAT(without.out, HasSubstr("texture 'my_child_skin.tga' is left out"));
  std::filesystem::remove(folder / "my_child.wrl");
  const auto half = animeme({"head", (folder / "my child.fdp").string()});
  EXPECT_EQ(half.exit_code, 3);
  EXPECT_THAT(half.err, HasSubstr("my child.fdp:10: "));
  EXPECT_THAT(half.err, HasSubstr((folder / "my_child.wrl").string()));
  EXPECT_THAT(half.err, HasSubstr("put the .wrl or .obj files"));
}

TEST(HeadCommand, SaysWhatIsWrong) {
  const TempDir dir;
  const auto expect = [&](const std::vector<std::string>& arguments, int code, const char* text) {
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr(text));
  };
  std::ofstream(dir / "cube.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::ofstream(dir / "points.csv") << "2.1,0\n8.3,7\n";
  std::ofstream(dir / "head.fdp") << "<xfdp><head>";
  std::ofstream(dir / "head.stl") << "solid\n";
  expect({"head", "dragon"}, 2, "woman, man, child");
  expect({"head", "man", "--points", dir / "points.csv"}, 2, "custom heads");
  expect({"head", dir / "cube.obj"}, 2, "add --points");
  expect({"head", dir / "head.stl"}, 2, ".glb, .gltf, .vrm, .fdp or .xmt");
  expect({"head", dir / "head.fdp", "--points", dir / "points.csv"}, 2, "has its own points");
  expect({"head", "man", "-o", dir / "man.stl"}, 2, ".fdp, .xmt, .glb or .obj");
  expect({"head", dir / "cube.obj", "--points", dir / "points.csv"}, 3, "points.csv:2: point 8.3");
  expect({"head", dir / "cube.obj", "--points", dir / "none.csv"}, 3, "none.csv");
  expect({"head", dir / "head.fdp"}, 3, "head.fdp:1");
}

}  // namespace head_test
}  // namespace animeme
