#include "tools/speech/text/written.h"

#include <gtest/gtest.h>

#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace written_test {

std::string read(const std::string& text, const std::string& language = "en-us",
                 bool spell_digits = false) {
  return utf8(read_written(as_written(code_points(text)), {language, false, spell_digits}).text);
}

#define SKIP_WITHOUT_ICU() \
  if (!unicode_here()) GTEST_SKIP() << "built without ICU"

TEST(Written, DatesByTheLocale) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(read("on 12/05/2024."), "on December 5th, 2024.");
  EXPECT_EQ(read("on 12/05/2024.", "en-gb"), "on 12th May 2024.");
  EXPECT_EQ(read("2024-05-12"), "May 12th, 2024");
  EXPECT_EQ(read("13/05/2024"), "May 13th, 2024") << "no such month";
  EXPECT_EQ(read("am 12.05.2024", "de"), "am zwölften Mai 2024");
  EXPECT_EQ(read("12.05.24", "de"), "zwölfter Mai 2024");
  EXPECT_EQ(read("12/05/2024", "fr"), "12 mai 2024");
  EXPECT_EQ(read("2024/5/12", "ja"), "2024年5月12日");
  EXPECT_TRUE(read("12.05.2024", "ru").ends_with("года"));
}

TEST(Written, WhatIsNoDate) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(read("32/13/2024"), "32 13 2024");
  EXPECT_EQ(read("version 1.2.3"), "version 1.2.3");
  EXPECT_EQ(read("192.168.1.10"), "192.168.1.10");
  EXPECT_EQ(read("30/02/2024"), "30 02 2024");
}

// Digits that are no number are said one by one, and nothing goes on for ever without a blank.
TEST(Written, RunsWithoutEndAreParted) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(read("x 1234567890123456789012345678901 y"),
            "x 1 2 3 4 5 6 7 8 9 0, 1 2 3 4 5 6 7 8 9 0, 1 2 3 4 5 6 7 8 9 0, 1 y");
  EXPECT_EQ(read("a card 1234567890123456"), "a card 1234567890123456");
  const std::string word(90, 'a');
  EXPECT_EQ(read(word), word);
  for (const std::string& piece :
       {std::string("1"), std::string("A."), std::string("a"), std::string("1a"), std::string("-"),
        std::string("1,"), std::string("é"), std::string("ก"), std::string("('"), std::string("1-"),
        std::string("a\u0301"), std::string("$1"), std::string("1/"), std::string("_a"),
        std::string("#"), std::string("a:"), std::string("🙂")}) {
    std::u32string text;
    while (text.size() < 5000) text += code_points(piece);
    const SpokenText spoken = read_written(as_written(text), {"en-us", false, false});
    EXPECT_LE(spoken.size(), 12 * text.size()) << piece;
    ASSERT_EQ(spoken.size(), spoken.places.size()) << piece;
    std::size_t run = 0, longest = 0;
    for (std::size_t i = 0; i < spoken.size(); ++i) {
      run = is_blank(spoken.text[i]) ? 0 : run + 1;
      longest = std::max(longest, run);
      EXPECT_LE(spoken.places[i].last, text.size());
      if (i > 0) {
        EXPECT_LE(spoken.places[i - 1].first, spoken.places[i].first) << piece;
      }
    }
    EXPECT_LE(longest, 250u) << piece;
  }
}

TEST(Written, AmountsInTheLanguage) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(read("$5.20"), "5 dollars and 20 cents");
  EXPECT_EQ(read("£0.99 or €1.00", "en-gb"), "99 pence or 1 euro");
  EXPECT_EQ(read("$5 million now"), "5 million dollars now");
  EXPECT_EQ(read("20 °C"), "20 degrees Celsius");
  EXPECT_EQ(read("60 km/h and 5 km"), "60 kilometers per hour and 5 kilometers");
  EXPECT_EQ(read("5,20 €", "de"), "5,20 Euro");
  EXPECT_EQ(read("20 °C", "de"), "20 Grad Celsius");
  EXPECT_EQ(read("5 man, 5 meters"), "5 man, 5 meters");
  EXPECT_EQ(read("1,234,567 and 3.14 and 50%"), "1,234,567 and 3.14 and 50%");
}

TEST(Written, NumbersTouchLettersOfScriptsWithoutBlanks) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(read("票价¥258.5。", "cmn"), "票价258.5元。");
  EXPECT_EQ(read("约20kg的米", "cmn"), "约20千克的米");
  EXPECT_EQ(read("₩1,200입니다", "ko"), "1200원입니다");
  EXPECT_EQ(read("x2m", "en"), "x2m");
}

TEST(Written, ThousandsPartedByBlanks) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(read("всего 100 000 штук", "ru"), "всего 100000 штук");
  EXPECT_TRUE(read("за 100 000 ₽", "ru").starts_with("за 100000 "));
  EXPECT_EQ(read("in 2020 100 men and 100 200", "en"), "in 2020 100 men and 100 200");
}

TEST(Written, TimesTelephonesAddresses) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(read("at 3:45pm"), "at 3:45 pm");
  EXPECT_EQ(read("at 3:45 pm or 15:30"), "at 3:45 pm or 15:30");
  EXPECT_EQ(read("15h30", "fr"), "15 heures 30");
  EXPECT_EQ(read("+1 (555) 123-4567"), "1, 5 5 5, 1 2 3, 4 5 6 7");
  EXPECT_EQ(read("555-123-4567"), "5 5 5, 1 2 3, 4 5 6 7");
  EXPECT_EQ(read("555-1234"), "5 5 5, 1 2 3 4");
  EXPECT_EQ(read("http://x.y/z"), "x.y, z");
  EXPECT_EQ(read("see https://www.example.com/."), "see example.com.");
}

TEST(Written, PunctuationIsNotNamed) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(read("wow !!! yes"), "wow! yes");
  EXPECT_EQ(read("Bonjour ! Ça va ?", "fr"), "Bonjour! Ça va?");
  EXPECT_EQ(read("so... what?!"), "so... what?");
  EXPECT_EQ(read("!!!"), "");
  EXPECT_EQ(read("and/or *bold* #tag a_b"), "and or bold  tag a b");
  EXPECT_EQ(read("hi 😀👍🏽 there"), "hi  there");
  EXPECT_EQ(read("2 = 2"), "2 = 2");
  EXPECT_EQ(read("l'été, c'est \"bien\" (oui).", "fr"), "l'été, c'est \"bien\" (oui).");
}

TEST(Written, JoinersOfIndianAndPersianLettersStay) {
  SKIP_WITHOUT_ICU();
  EXPECT_EQ(read("क्‍ष", "hi"), "क्‍ष");
  EXPECT_EQ(read("می‌خواهم", "fa"), "می‌خواهم");
}

TEST(Written, NumbersInWordsWhereAVoiceSaysNone) {
  SKIP_WITHOUT_ICU();
  const std::string words = read("12 שקל", "he", true);
  EXPECT_TRUE(words.ends_with(" שקל"));
  EXPECT_EQ(words.find("12"), std::string::npos);
}

TEST(Written, EachCharacterKnowsItsPlace) {
  SKIP_WITHOUT_ICU();
  const std::u32string source = U"am 12.05.2024 da";
  const SpokenText said = read_written(as_written(source), {"de"});
  ASSERT_EQ(said.text, U"am zwölften Mai 2024 da");
  EXPECT_EQ(said.place(3, 20), (Place{3, 13}));
  EXPECT_EQ(said.place(21, 23), (Place{14, 16}));
}

}  // namespace written_test
}  // namespace animeme::text
