// The fixtures in tests/data/fap.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fap/text.h"
#include "tests/fap/make.h"
#include "tests/support/files.h"
#include "tests/support/shared.h"

namespace animeme::fap {
namespace text_data_test {

using made::make_frame;
using ::testing::ElementsAre;
using ::testing::StartsWith;

Sequence read(const char* name, std::vector<std::string>* warnings) {
  const Result<Sequence> clip =
      read_text(test::data_file(std::string("fap/") + name), {}, warnings);
  EXPECT_TRUE(clip) << name << ":" << (clip ? "" : clip.error().describe());
  return clip ? *clip : Sequence{};
}

TEST(TextData, SafeFormIsWrittenByteForByte) {
  for (const char* name : {"plain.fap", "high_level.fap"}) {
    std::vector<std::string> warnings;
    EXPECT_EQ(write_text(read(name, &warnings)), test::data_file(std::string("fap/") + name));
    EXPECT_THAT(warnings, ElementsAre());
  }
}

TEST(TextData, Quirks) {
  std::vector<std::string> warnings;
  const Sequence clip = read("quirks.fap", &warnings);
  EXPECT_EQ(clip.name, "a name with blanks.fap");
  EXPECT_EQ(clip.rate, (Rate{30000, 1001}));
  EXPECT_THAT(clip.frames, ElementsAre(make_frame(0, {{3, 2}, {5, -2}, {51, 3}, {52, 4}}),
                                       make_frame(1, {{3, 5}, {5, 6}, {51, 7}, {52, 8}}),
                                       make_frame(2, {{3, 1}, {5, 1}, {51, 1}, {52, 1}}),
                                       make_frame(3, {{3, 2}, {5, 2}, {51, 2}, {52, 2}})));
  EXPECT_THAT(warnings, ElementsAre(StartsWith("line 1: the text has a byte order mark"),
                                    StartsWith("line 3: the name contains blanks"),
                                    StartsWith("line 3: the header says 99 frames, the text has 5"),
                                    StartsWith("line 4: a mask has 69 values"),
                                    StartsWith("line 5: the value '1.5' is rounded"),
                                    StartsWith("line 5: the frame numbers start at 7"),
                                    StartsWith("line 8: the values of a frame continue"),
                                    StartsWith("line 11: frame number 8 comes again"),
                                    StartsWith("line 13: frame number 2 comes after 8"),
                                    StartsWith("line 14: the values are on the line of the mask")));
}

TEST(TextData, Headerless) {
  std::vector<std::string> warnings;
  const Sequence clip = read("headerless.fap", &warnings);
  ASSERT_EQ(clip.frames.size(), 2u);
  EXPECT_EQ(clip.frames[1], make_frame(2, {{3, 5}, {5, 6}, {51, 7}, {52, 8}}));
  EXPECT_EQ(warnings.size(), 2u);
}

}  // namespace text_data_test
}  // namespace animeme::fap
