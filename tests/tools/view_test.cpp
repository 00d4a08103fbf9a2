// `animeme view` as a user calls it.
#include <gmock/gmock.h>

#include "tests/support/program.h"

namespace animeme::test {
namespace {

using testing::HasSubstr;

const std::string kData = ANIMEME_SOURCE_DIR "/tests/data/";

TEST(ViewCommand, WritesOnePageOfEachKindOfInput) {
  const TempDir dir;
  const std::string curves = kData + "grid_s1_sample/fap/prac8p.csv";
  const std::string script = kData + "grid_s1_sample/phonemes/prac8p.tsv";
  const auto silent =
      animeme({"view", curves, "--script", script, "--head", "child", "-o", dir / "a.html"});
  EXPECT_EQ(silent.exit_code, 0) << silent.err;
  EXPECT_THAT(silent.err, HasSubstr("silent"));
  const std::string page = slurp(dir / "a.html");
  EXPECT_THAT(page, HasSubstr("<title>prac8p.csv</title>"));
  EXPECT_THAT(page, HasSubstr("\"please\""));
  EXPECT_LE(page.size(), 3'000'000u);
  const auto pair = animeme({"view", kData + "containers/std_aac.mp4", curves, "-o", "-"});
  EXPECT_EQ(pair.exit_code, 0) << pair.err;
  EXPECT_THAT(pair.err, HasSubstr("with sound"));
  EXPECT_THAT(pair.out, HasSubstr("id=\"clip1\""));
  EXPECT_THAT(pair.out, HasSubstr("id=\"sound\""));
  const auto faceless =
      animeme({"view", kData + "containers/iso_reference_fba_only.mp4", "-o", dir / "b.html"});
  EXPECT_EQ(faceless.exit_code, 0) << faceless.err;
  EXPECT_THAT(faceless.err, HasSubstr("silent"));
}

TEST(ViewCommand, SaysWhatIsWrong) {
  const TempDir dir;
  const std::string curves = kData + "grid_s1_sample/fap/prac8p.csv";
  const auto head = animeme({"view", curves, "--head", "dog", "-o", dir / "a.html"});
  EXPECT_EQ(head.exit_code, 2);
  EXPECT_THAT(head.err, HasSubstr("woman, man or child"));
  EXPECT_EQ(animeme({"view", dir / "none.fap", "-o", dir / "a.html"}).exit_code, 3);
  const auto sound = animeme({"view", curves, "--audio", curves, "-o", dir / "a.html"});
  EXPECT_EQ(sound.exit_code, 3);
  EXPECT_THAT(sound.err, HasSubstr("prac8p.csv"));
  EXPECT_EQ(dir.files().size(), 0u);
}

}  // namespace
}  // namespace animeme::test
