// FAP files of real programs: each is read, or refused with a reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "fap/text.h"
#include "tests/support/files.h"
#include "tests/support/shared.h"

namespace animeme::fap {
namespace wild_fap_test {

std::vector<std::filesystem::path> fap_files(const std::filesystem::path& dir) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(dir)) {
    if (entry.path().extension() == ".fap") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class WildFap : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::shared_dir().empty()) GTEST_SKIP() << "no reference data (ANIMEME_SHARED)";
  }
};

TEST_F(WildFap, AllAreReadAndWrittenBack) {
  const auto files = fap_files(test::shared_dir() / "wild_fap");
  ASSERT_FALSE(files.empty());
  for (const auto& path : files) {
    const Result<Sequence> clip = read_text(test::slurp(path));
    ASSERT_TRUE(clip) << path << ": " << clip.error().describe();
    EXPECT_FALSE(clip->frames.empty()) << path;
    const Result<Sequence> again = read_text(write_text(*clip));
    ASSERT_TRUE(again) << path << ": " << again.error().describe();
    EXPECT_EQ(again->frames, clip->frames) << path;
  }
}

TEST_F(WildFap, KnownContent) {
  const auto dir = test::shared_dir() / "wild_fap";
  const auto read = [&](const char* name) {
    Result<Sequence> clip = read_text(test::slurp(dir / name));
    EXPECT_TRUE(clip) << name;
    return clip ? *clip : Sequence{};
  };
  const Sequence jag = read("jag.fap");
  EXPECT_EQ(jag.rate, (Rate{5, 1}));
  ASSERT_EQ(jag.frames.size(), 169u);
  EXPECT_EQ(jag.frames[0].value[3], 57);
  EXPECT_EQ(jag.frames[0].value[48], -7716);
  EXPECT_EQ(jag.frames[0].mask.count(), 66u);

  const Sequence eyes = read("eyes.fap");
  ASSERT_EQ(eyes.frames.size(), 52u);
  EXPECT_EQ(eyes.frames.back().number, 51);
  EXPECT_EQ(eyes.frames.back().value[19], -500);

  const Sequence greta = read("greta_AU_Interpolation_2.fap");
  EXPECT_EQ(greta.name, "AU Interpolation_2.fap");
  ASSERT_EQ(greta.frames.size(), 1u);
  EXPECT_EQ(greta.frames[0].value[3], 73);
  EXPECT_EQ(greta.frames[0].value[63], 0);

  const Sequence bus = read("semaine_bus_message.fap");
  ASSERT_GE(bus.frames.size(), 49u);
  EXPECT_EQ(bus.frames[1].value[3], 125);
}

// The sources and expected decodes of the conformance streams are FAP text as well.
TEST_F(WildFap, ConformanceTexts) {
  const auto files = fap_files(test::shared_dir() / "conformance" / "streams");
  ASSERT_FALSE(files.empty());
  for (const auto& path : files) {
    const Result<Sequence> clip = read_text(test::slurp(path));
    EXPECT_TRUE(clip) << path << ": " << clip.error().describe();
  }
}

}  // namespace wild_fap_test
}  // namespace animeme::fap
