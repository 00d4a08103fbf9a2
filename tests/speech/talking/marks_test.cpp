#include "tools/speech/talking/marks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dam/script/textgrid.h"

namespace animeme::speech {
namespace marks_test {

using testing::ElementsAre;
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

constexpr const char* kWords[] = {"one", "two", "three"};

dam::Script three_words() {
  dam::Script script{{{0, 0.5, "SIL", ""}}};
  for (int i = 0; i < 3; ++i) {
    const double start = 0.5 + 0.25 * i;
    script.phones.push_back({start, start + 0.125, "P", kWords[i]});
    script.phones.push_back({start + 0.125, start + 0.25, "AA", kWords[i]});
  }
  script.phones.push_back({1.25, 1.5, "SIL", ""});
  return script;
}

std::vector<std::string> texts_of(const std::string& written, const std::string& name) {
  std::vector<std::string> texts;
  const auto grid = dam::parse_textgrid(written);
  if (!grid) return texts;
  for (const dam::TextGridTier& tier : grid->tiers) {
    double now = 0;
    for (const dam::TextGridItem& item : tier.items) {
      if (!tier.points) {
        EXPECT_DOUBLE_EQ(item.start, now) << tier.name;
      }
      now = item.end;
      if (tier.name == name && !item.text.empty()) texts.push_back(item.text);
    }
  }
  return texts;
}

TEST(Doubts, WordsHaveATier) {
  const dam::Script script = three_words();
  const std::vector<double> sure = {1, 0.9, 0.8, 0.02, 0.03, 0.7, 0.6, 1};
  std::vector<voice::AlignedWord> words(4);
  for (std::size_t i = 0; i < 3; ++i) {
    words[i] = {
        kWords[i], 0.5 + 0.25 * double(i), 0.75 + 0.25 * double(i), i == 1 ? 0.025 : 0.8, true,
        true};
  }
  words[3] = {"unsaid", 1.25, 1.25, 0, false, true};
  const std::string text = write_marked_script(script, {}, ".TextGrid", doubts_of(sure, words));
  EXPECT_THAT(texts_of(text, "doubtful"), ElementsAre("two 0.03"));
  EXPECT_THAT(texts_of(text, "confidence"),
              ElementsAre("0.90", "0.80", "0.02", "0.03", "0.70", "0.60"));
  // It is still a script, and the same one.
  const auto again = dam::read_script(text);
  ASSERT_TRUE(again) << again.error().describe();
  EXPECT_EQ(dam::write_script(*again, ".tsv"), dam::write_script(script, ".tsv"));
  EXPECT_EQ(write_marked_script(script, {}, ".tsv", doubts_of(sure, words)),
            dam::write_script(script, ".tsv"));
}

TEST(Doubts, PhonesOfSoundAloneAreJoined) {
  const dam::Script script = three_words();
  const std::vector<double> sure = {0, 0.9, 0.4, 0.2, 0.8, 0.9, 0.3, 0};
  const std::string text = write_marked_script(script, {}, ".TextGrid", doubts_of(script, sure));
  EXPECT_THAT(texts_of(text, "doubtful"), ElementsAre("AA P 0.30", "AA 0.30"));
}

}  // namespace marks_test
}  // namespace animeme::speech
