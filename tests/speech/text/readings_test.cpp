// Chinese and Japanese readings.
#include <gtest/gtest.h>

#include "tools/speech/text/chinese.h"
#include "tools/speech/text/japanese.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/word_readings.h"

namespace animeme::text {
namespace readings_test {

std::string chinese(const std::string& text) {
  std::u32string unread;
  const SpokenText said = spell_han_numbers(as_written(code_points(text)), false);
  return utf8(read_chinese(said, unread).text) + utf8(unread);
}

std::string japanese(const std::string& text) {
  std::u32string unread;
  const auto said = read_japanese(as_written(code_points(text)), unread);
  return said ? utf8(said->text) : said.error().describe();
}

#define SKIP_WITHOUT_CHINESE()                                 \
  if (!unicode_here() || !has_chinese_words()) {               \
    GTEST_SKIP() << "rime-data-pinyin-simp or ICU is missing"; \
  }
#define SKIP_WITHOUT_JAPANESE() \
  if (!unicode_here() || !japanese_words(U"日")) GTEST_SKIP() << "mecab-ipadic-utf8 is missing"

std::string syllables(std::string text) {
  std::erase_if(text, [](char c) { return (c >= '0' && c <= '9') || c == ' '; });
  return text;
}

TEST(Chinese, CharactersOfSeveralReadings) {
  SKIP_WITHOUT_CHINESE();
  const std::pair<const char*, const char*> words[] = {
      {"银行", "yinhang"},   {"行为", "xingwei"}, {"长大", "zhangda"}, {"长城", "changcheng"},
      {"音乐", "yinyue"},    {"快乐", "kuaile"},  {"了解", "liaojie"}, {"好了", "haole"},
      {"重庆", "chongqing"}, {"觉得", "juede"},   {"还有", "haiyou"}};
  int right = 0, characters = 0;
  for (const auto& [word, reading] : words) {
    right += syllables(chinese(word)) == reading;
    EXPECT_EQ(syllables(chinese(word)), reading) << word;
    std::string one;
    for (const char32_t c : code_points(word)) one += syllables(pinyin_of(c));
    characters += one == reading;
  }
  std::printf("of 11 words: by Rime's list %d, by ICU's characters %d\n", right, characters);
  EXPECT_EQ(syllables(chinese("銀行 行為 長大 音樂")), "yinhangxingweizhangdayinyue");
}

TEST(Chinese, TonesAndRoundVowels) {
  SKIP_WITHOUT_CHINESE();
  EXPECT_EQ(chinese("你好，女人"), "ni3hao3，nv3ren2");
  EXPECT_EQ(chinese("音乐"), "yin1yue4");
}

TEST(Chinese, NumbersInChinese) {
  SKIP_WITHOUT_CHINESE();
  const auto spelled = [](const char* text) {
    return utf8(spell_han_numbers(as_written(code_points(text)), false).text);
  };
  EXPECT_EQ(spelled("2024年5月12日"), "二〇二四年五月十二日");
  EXPECT_EQ(spelled("15%"), "百分之十五");
  EXPECT_EQ(spelled("3:45"), "三点四十五分");
  EXPECT_EQ(spelled("3.5"), "三点五");
  EXPECT_EQ(spelled("13800138000"), "一三八〇〇一三八〇〇〇");
  EXPECT_EQ(spelled("2个"), "两个");
  EXPECT_EQ(spelled("123,456"), "十二万三千四百五十六");
}

TEST(Chinese, WithoutADictionaryCharacterByCharacter) {
  if (!unicode_here()) GTEST_SKIP() << "built without ICU";
  std::u32string unread;
  EXPECT_FALSE(has_chinese_words("/nowhere"));
  EXPECT_EQ(utf8(read_chinese(as_written(U"你好"), unread, "/nowhere").text), "ni3 hao3");
}

TEST(Japanese, ParticlesAndLongVowels) {
  SKIP_WITHOUT_JAPANESE();
  EXPECT_EQ(japanese("今日は東京へ行きます。"), "キョオワ トオキョオエ イキマス。");
  EXPECT_EQ(japanese("本を読む"), "ホンヲ ヨム");
  EXPECT_EQ(japanese("ラーメン"), "ラアメン");
  EXPECT_EQ(japanese("私はPythonが好き"), "ワタシワ Python ガ スキ");
}

TEST(Japanese, NumbersWithTheirCounters) {
  SKIP_WITHOUT_JAPANESE();
  EXPECT_EQ(japanese("4月"), "シガツ");
  EXPECT_EQ(japanese("7時"), "ナナジ") << "or シチジ";
}

TEST(Japanese, WithoutADictionaryKanaAlone) {
  if (!unicode_here()) GTEST_SKIP() << "built without ICU";
  std::u32string unread;
  const auto kana = read_japanese(as_written(U"ラーメン"), unread, "/nowhere");
  ASSERT_TRUE(kana) << kana.error().describe();
  EXPECT_EQ(kana->text, U"ラアメン");
  const auto kanji = read_japanese(as_written(U"日本"), unread, "/nowhere");
  ASSERT_FALSE(kanji);
  EXPECT_NE(kanji.error().message.find("mecab-ipadic-utf8"), std::string::npos);
}

TEST(WordReadings, TranscriptsWithoutBlanks) {
  SKIP_WITHOUT_CHINESE();
  const auto words = word_readings("我去银行。", "zh");
  ASSERT_TRUE(words);
  ASSERT_GE(words->size(), 2u);  // 我去 may be one
  EXPECT_EQ(words->back().text, "银行");
  EXPECT_EQ(words->back().reading, "yin2hang2");
  EXPECT_FALSE(has_unparted_words("de"));
}

TEST(WordReadings, JapaneseParticlesStayWithTheirWords) {
  SKIP_WITHOUT_JAPANESE();
  const auto words = word_readings("私は学生です。", "ja");
  ASSERT_TRUE(words);
  ASSERT_EQ(words->size(), 2u);
  EXPECT_EQ((*words)[0].text, "私は");
  EXPECT_EQ((*words)[1].text, "学生です");
}

}  // namespace readings_test
}  // namespace animeme::text
