#include "tools/speech/voice/word_phones.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dam/script/script.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {
namespace word_phones_test {

bool no_voices() {
  const auto voices = list_voices();
  return !voices && voices.error().code == Code::unsupported;
}

dam::TimedLabel word(double start, double end, const char* text) {
  return {start, end, text, {}, 7, 3, true, dam::Alphabet::automatic};
}

std::string labels(const dam::Timings& timings) {
  std::string out;
  for (const dam::TimedLabel& label : timings.labels) out += label.label + " ";
  return out;
}

TEST(WordPhones, ShareTheTimeOfTheirWord) {
  if (no_voices()) GTEST_SKIP() << "built without espeak-ng";
  std::vector<std::string> warnings;
  const auto filled = words_to_phones(
      {"words", dam::Alphabet::automatic, {word(0.2, 0.5, "Bin,"), word(0.6, 1.4, "bin blue")}}, {},
      warnings);
  ASSERT_TRUE(filled) << filled.error().describe();
  EXPECT_EQ(labels(*filled), "B IH N B IH N B L UW ");
  EXPECT_TRUE(warnings.empty());
  EXPECT_FALSE(dam::has_words(*filled));
  const auto& all = filled->labels;
  EXPECT_EQ(all[0].start, 0.2);
  EXPECT_EQ(all[2].end, 0.5);
  EXPECT_EQ(all[3].start, 0.6);
  EXPECT_EQ(all[8].end, 1.4);
  EXPECT_NEAR((all[1].end - all[1].start) / (all[0].end - all[0].start), 1.4, 1e-9);
  EXPECT_EQ(all[5].end, all[6].start);
  EXPECT_EQ(all[4].word, "bin");
  EXPECT_EQ(all[4].line, 7);
  const auto script = dam::make_script(*filled);
  ASSERT_TRUE(script) << script.error().describe();
  EXPECT_EQ(script->duration(), 1.4);
}

// Phones that are there already stay as they are, in letters of their own.
TEST(WordPhones, PhonesBesideThemStay) {
  if (no_voices()) GTEST_SKIP() << "built without espeak-ng";
  std::vector<std::string> warnings;
  dam::TimedLabel ipa{0, 0.1, "ʃ", "ship", 1, 1, false, dam::Alphabet::automatic};
  const auto filled = words_to_phones(
      {"inworld", dam::Alphabet::automatic, {ipa, word(0.1, 0.3, "see"), word(0.3, 0.4, "--")}}, {},
      warnings);
  ASSERT_TRUE(filled) << filled.error().describe();
  EXPECT_EQ(labels(*filled), "ʃ S IY ");
  const auto script = dam::make_script(*filled);
  ASSERT_TRUE(script) << script.error().describe();
  EXPECT_EQ(script->phones[0].label, "SH");
}

TEST(WordPhones, AWordTakesTime) {
  if (no_voices()) GTEST_SKIP() << "built without espeak-ng";
  std::vector<std::string> warnings;
  const auto filled =
      words_to_phones({"words", dam::Alphabet::automatic, {word(0.2, 0.2, "bin")}}, {}, warnings);
  ASSERT_FALSE(filled);
  EXPECT_EQ(filled.error().where.line, 7);
  EXPECT_EQ(filled.error().where.column, 3);
}

TEST(WordPhones, OtherLanguagesAreSpoken) {
  if (no_voices()) GTEST_SKIP() << "built without espeak-ng";
  std::vector<std::string> warnings;
  AlignOptions options;
  options.language = "de";
  const auto filled = words_to_phones({"words", dam::Alphabet::automatic, {word(0, 0.5, "schön")}},
                                      options, warnings);
  ASSERT_TRUE(filled) << filled.error().describe();
  EXPECT_EQ(filled->labels.front().label, "SH");
  EXPECT_EQ(filled->labels.back().label, "N");
}

}  // namespace word_phones_test
}  // namespace animeme::voice
