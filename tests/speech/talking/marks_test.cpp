#include "tools/speech/talking/marks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace animeme::speech {
namespace marks_test {

using testing::HasSubstr;

const dam::Script kScript{{{0, 0.5, "SIL", ""}, {0.5, 1, "AA", "a"}}};

TEST(Marks, FormatsThatHoldThem) {
  const std::vector<voice::SpeechMark> marks = {{0.25, "start --> \"x\""}};
  const std::string grid = write_marked_script(kScript, marks, ".TextGrid");
  EXPECT_THAT(grid, HasSubstr("name = \"marks\""));
  EXPECT_THAT(grid, HasSubstr("0.25"));
  EXPECT_THAT(grid, HasSubstr("\"\"x\"\""));
  const std::string vtt = write_marked_script(kScript, marks, ".vtt");
  EXPECT_THAT(vtt, HasSubstr("NOTE mark 00:00:00.250 start - -> \"x\""));
}

TEST(Marks, OthersAreAsWithout) {
  const std::vector<voice::SpeechMark> marks = {{0.25, "m"}};
  EXPECT_EQ(write_marked_script(kScript, marks, ".tsv"), dam::write_script(kScript, ".tsv"));
  EXPECT_EQ(write_marked_script(kScript, {}, ".vtt"), dam::write_script(kScript, ".vtt"));
}

}  // namespace marks_test
}  // namespace animeme::speech
