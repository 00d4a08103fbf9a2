// Damaged files: commands do what can be done, say what is lost, and end with exit code 1; with
// --strict they fail.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "codec/decode/access_unit.h"
#include "tests/app/program/commands.h"
#include "tests/support/files.h"
#include "tests/support/random_clip.h"
#include "tests/support/temp_dir.h"

namespace animeme {
namespace damage_program_test {

using test::animeme;
using test::TempDir;
using testing::HasSubstr;

class DamagedFile : public testing::TestWithParam<const char*> {
 protected:
  // Ten seconds with an intra plane a second, carried as the parameter says.
  void SetUp() override {
    fap::Sequence clip = test::random_clip(5, 250);
    clip.rate = {25, 1};
    test::spill(dir / "clip.fap", fap::write_text(clip));
    file = dir / "clip" + GetParam();
    if (GetParam() == std::string(".fba")) {
      test::succeeds({"mux", dir / "clip.fap", "-o", dir / "clip.mp4", "--intra-seconds", "1"});
      test::succeeds({"demux", dir / "clip.mp4", "-o", file});
    } else {
      const auto muxed = animeme({"mux", dir / "clip.fap", "-o", file, "--intra-seconds", "1"});
      if (muxed.exit_code == 3) GTEST_SKIP() << muxed.err;
      ASSERT_EQ(muxed.exit_code, 0) << muxed.err;
    }
    test::succeeds({"decode", file, "-o", dir / "good.fap"});
    test::Bytes bytes = test::read_bytes(file);
    // The start code of a plane in the middle.
    const test::Bytes code = {0, 0, 1, 0xBB};
    const auto at = std::search(bytes.begin() + std::ptrdiff_t(bytes.size() / 2), bytes.end(),
                                code.begin(), code.end());
    ASSERT_NE(at, bytes.end());
    at[3] = 0x5B;
    test::spill(file, std::string(bytes.begin(), bytes.end()));
  }

  TempDir dir;
  std::string file;
};

TEST_P(DamagedFile, IsHeldWhereItIsDamaged) {
  const auto decoded = animeme({"decode", file, "-o", dir / "left.fap"});
  EXPECT_EQ(decoded.exit_code, 1) << decoded.err;
  EXPECT_THAT(decoded.err, HasSubstr("warning: " + file + ": damaged at "));
  EXPECT_THAT(decoded.err, HasSubstr(" frames are lost"));
  const fap::Sequence good = test::read_clip(dir / "good.fap"),
                      left = test::read_clip(dir / "left.fap");
  ASSERT_EQ(left.frames.size(), good.frames.size());
  std::size_t same = 0;
  for (std::size_t i = 0; i < good.frames.size(); ++i) {
    same += left.frames[i].value == good.frames[i].value ? 1 : 0;
  }
  EXPECT_GE(same, good.frames.size() - 30);
  EXPECT_LT(same, good.frames.size());
  EXPECT_EQ(left.frames.back(), good.frames.back());

  // The stream is whole again in what demux and mux write.
  EXPECT_EQ(animeme({"mux", file, "-o", dir / "again.mkv"}).exit_code, 1);
  test::succeeds({"decode", dir / "again.mkv", "-o", dir / "again.fap"});
  EXPECT_EQ(test::read_clip(dir / "again.fap").frames, left.frames);
  if (GetParam() != std::string(".fba")) {
    EXPECT_EQ(animeme({"demux", file, "-o", dir / "again.fba"}).exit_code, 1);
    test::succeeds({"decode", dir / "again.fba", "-o", dir / "again.fap"});
    EXPECT_EQ(test::read_clip(dir / "again.fap").frames, left.frames);
  }
}

TEST_P(DamagedFile, IsReportedByEachCommand) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"info", file},
                                             {"stats", file},
                                             {"encode", file, "-o", dir / "a.fba"},
                                             {"export", file, "-o", dir / "a.csv"},
                                             {"plot", file, "-o", dir / "a.svg"},
                                             {"compare", file, file}}) {
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments[0] << ": " << result.err;
    EXPECT_THAT(result.err, HasSubstr("damaged at ")) << arguments[0];
  }
  const test::Json json = test::json_of({"compare", file, file}, 1);
  EXPECT_EQ(json["damaged"], true);
  EXPECT_EQ(json["equal"], true);
}

TEST_P(DamagedFile, IsAnErrorIfStrict) {
  // Without its start code a plane is none: of a stream it ends the object, and readers of
  // containers leave it out with those that follow it. Both are warnings.
  const auto decoded = animeme({"decode", file, "-o", dir / "left.fap", "--strict"});
  EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
  EXPECT_THAT(decoded.err, HasSubstr("warning: "));
  EXPECT_LT(test::read_clip(dir / "left.fap").frames.size(), 250u);
  if (GetParam() != std::string(".fba")) return;
  test::Bytes bytes = test::read_bytes(file);
  bytes[12] ^= 0xFF;  // masks of the first plane
  test::spill(file, std::string(bytes.begin(), bytes.end()));
  const auto strict = animeme({"decode", file, "-o", dir / "strict.fap", "--strict"});
  EXPECT_EQ(strict.exit_code, 3) << strict.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "strict.fap"));
  EXPECT_EQ(animeme({"decode", file, "-o", dir / "held.fap"}).exit_code, 1);
  EXPECT_EQ(test::read_clip(dir / "held.fap").frames.size(), 250u);
}

INSTANTIATE_TEST_SUITE_P(Kinds, DamagedFile, testing::Values(".fba", ".mp4", ".mkv", ".ts"),
                         [](const auto& one) { return std::string(one.param + 1); });

}  // namespace damage_program_test
}  // namespace animeme
