// What the players that exist stumble over.
#include "fap/players.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fap/text.h"
#include "tests/fap/make.h"
#include "tests/support/files.h"
#include "tests/support/shared.h"

namespace animeme::fap {
namespace players_test {

using made::make_frame;
using made::mask_line;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const std::string kMask = mask_line({3, 4}) + "\n";
const std::string kTwo = kMask + "0 1 2\n" + kMask + "1 3 4\n";

TEST(Players, TakeWhatWriteTextWrites) {
  EXPECT_THAT(player_problems("2.1 x 25 2\n" + kTwo), IsEmpty());
  const Sequence clip{{30000, 1001}, {make_frame(0, {{3, 1}}), make_frame(1, {{3, 2}})}, "a b"};
  EXPECT_THAT(player_problems(write_text(clip, {.whole_rate = true})), IsEmpty());
  EXPECT_THAT(player_problems("2.1 x 25 2\r\n" + kTwo + "\n\n"), IsEmpty());
  EXPECT_THAT(player_problems("2.1 x 25 0\n"), IsEmpty());
}

TEST(Players, StumbleOverEachOfThese) {
  const auto one = [](const std::string& text, const std::string& line, const std::string& what) {
    EXPECT_THAT(player_problems(text),
                ElementsAre(testing::AllOf(StartsWith("line " + line + ": "), HasSubstr(what))))
        << text;
  };
  one("", "1", "there is no header");
  one(kTwo, "1", "not a header");
  one("2.1 a b 25 2\n" + kTwo, "1", "not a header");
  one("2.1 x 29.97 2\n" + kTwo, "1", "'29.97' is not whole");
  one("2.1 x 0 2\n" + kTwo, "1", "not whole");
  one("2.1 x 25 3\n" + kTwo, "1", "says 3 frames, there are 2");
  one("2.1 " + std::string(255, 'n') + " 25 2\n" + kTwo, "1", "longer than 254");
  one("# hello\n2.1 x 25 2\n" + kTwo, "1", "no frames behind it");
  one("2.1 x 25 2\n# hello\n" + kTwo, "2", "Xface crashes");
  one("2.1 x 25 2\n" + kTwo + "# the end\n", "6", "a comment");
  one("2.1 x 25 2\n\n" + kTwo, "2", "blank line");
  one("2.1 x 25 1\n" + kMask + "0 1 2", "3", "no newline");
  one("2.1 x 25 1\n0 " + kMask + "0 1 2\n", "2", "69 words");
  one("2.1 x 25 1\n2" + kMask.substr(1) + "0 1 2\n", "2", "'2' for 0 or 1");
  one("2.1 x 25 1\n" + kMask + "0 1\n", "3", "2 words for a number and 2 values");
  one("2.1 x 25 1\n" + kMask + "0 1 2.5\n", "3", "'2.5' is not a whole number");
  one("2.1 x 25 1\n" + kMask, "2", "no values");
  one("2.1 x 25 2\n" + kMask + "0 1 2\n" + kMask + "3 1 2\n", "5", "of frame 1 is 3");
  one("2.1 x 25 1\n" + mask_line({19}) + "\n0 7\n", "2", "not FAP 20");
  one("2.1 x 25 2\n" + kMask + "0 1 2\n" + mask_line({3}) + "\n1 2\n", "4", "FAP 4 was present");
  one("2.1 x 25 1\n" + mask_line({1}) + "\n0 1 0 63 0\n", "2", "--expand");
  one("2.1 x 25 1\n" + mask_line({2, 3}) + "\n0 1 63 0 0 0 0 9\n", "2", "with low-level FAPs");
}

TEST(Players, HighLevelOnesTakeFap1And2Alone) {
  const std::string alone = "2.1 x 25 1\n" + mask_line({1}) + "\n0 1 0 63 0\n";
  EXPECT_THAT(player_problems(alone, {.high_level = true}), IsEmpty());
  const std::string both = "2.1 x 25 1\n" + mask_line({1, 3}) + "\n0 1 0 63 0 5\n";
  EXPECT_THAT(player_problems(both, {.high_level = true}),
              ElementsAre(HasSubstr("with low-level FAPs")));
}

TEST(Players, EachKindIsOneLineWithItsCount) {
  std::string text = "2.1 x 25 4\n";
  for (const int number : {1, 2, 3, 4}) text += kMask + std::to_string(number) + " 1 2\n";
  EXPECT_THAT(player_problems(text), ElementsAre(HasSubstr("(and in 3 more places)")));
}

// Files that made these players what they are: all but those with quirks are right.
TEST(Players, WildFiles) {
  const std::filesystem::path folder = test::shared_dir() / "wild_fap";
  if (test::shared_dir().empty() || !std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "no reference data: set ANIMEME_SHARED";
  }
  EXPECT_THAT(player_problems(test::slurp(folder / "greta_UniqueId_214.fap")),
              testing::Not(IsEmpty()));
  EXPECT_THAT(player_problems(test::slurp(folder / "semaine_bus_message.fap")),
              ElementsAre(HasSubstr("header")));
  EXPECT_THAT(player_problems(test::slurp(folder / "eyes.fap")),
              testing::Contains(HasSubstr("of frame 0 is 1")));
}

}  // namespace players_test
}  // namespace animeme::fap
