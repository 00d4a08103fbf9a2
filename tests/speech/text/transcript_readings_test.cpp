// Tokens of a transcript and the ways to say them.
#include <gtest/gtest.h>

#include <algorithm>

#include "tools/speech/text/readings.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace transcript_readings_test {

#define SKIP_WITHOUT_ICU() \
  if (!unicode_here()) GTEST_SKIP() << "built without ICU"

std::string listed(const Token& token) {
  std::string all;
  for (const std::string& reading : token.readings) all += "[" + reading + "]";
  return all;
}

TEST(TranscriptReadings, EachWayThatPeopleSay) {
  SKIP_WITHOUT_ICU();
  const struct {
    const char *language, *text;
    std::vector<std::string> ways;
  } kRows[] = {
      {"en",
       "1984",
       {"nineteen eighty-four", "one thousand nine hundred eighty-four", "one nine eight four"}},
      {"en", "1905", {"nineteen oh five", "nineteen hundred and five"}},
      {"en", "2005", {"two thousand five", "two thousand and five"}},
      {"en", "2024", {"twenty twenty-four", "two thousand twenty-four", "two oh two four"}},
      {"en",
       "550",
       {"five hundred fifty", "five hundred and fifty", "five fifty", "five five zero"}},
      {"en", "$500", {"five hundred dollars", "five hundred"}},
      {"en", "$5.50", {"five dollars fifty", "five fifty", "five dollars and fifty cents"}},
      {"en", "£3bn", {"three billion pounds"}},
      {"en", "3/4", {"three quarters", "three fourths", "three over four", "March fourth"}},
      {"en", "1 1/2", {"one and a half"}},
      {"en", "24/7", {"twenty-four seven"}},
      {"en", "50 %", {"fifty percent"}},
      {"en", "5th", {"fifth"}},
      {"en", "5", {"five", "fifth"}},
      {"en", "1980s", {"nineteen eighties"}},
      {"en", "3:45", {"three forty-five", "quarter to four"}},
      {"en", "3:45pm", {"three forty-five p m"}},
      {"en", "9:00", {"nine o'clock", "nine"}},
      {"en", "9:40", {"nine forty", "twenty to ten"}},
      {"en",
       "12/05/2024",
       {"December fifth twenty twenty-four", "the fifth of December twenty twenty-four",
        "the twelfth of May twenty twenty-four"}},
      {"en", "1990-1995", {"nineteen ninety to nineteen ninety-five"}},
      {"en", "COVID-19", {"COVID nineteen"}},
      {"en", "MP3", {"M P three"}},
      {"en", "R&D", {"R and D"}},
      {"en", "C#", {"C sharp"}},
      {"en", "VIII", {"eight", "the eighth"}},
      {"en", "Dr.", {"doctor", "drive"}},
      {"en", "+1 555 123-4567", {"one five five five one two three four five six seven"}},
      {"de", "1984", {"neunzehnhundertvierundachtzig", "eintausendneunhundertvierundachtzig"}},
      {"de", "12,50 €", {"zwölf Euro fünfzig", "zwölf Komma fünf null Euro", "zwölf fünfzig"}},
      {"de", "9:30 Uhr", {"neun Uhr dreißig", "halb zehn"}},
      {"de", "z. B.", {"zum Beispiel"}},
      {"de", "100 km/h", {"hundert Kilometer pro Stunde", "einhundert Stundenkilometer"}},
      {"de",
       "3.5.1999",
       {"dritten Mai neunzehnhundertneunundneunzig",
        "dritter fünfter neunzehnhundertneunundneunzig"}},
      {"de", "3/4", {"drei Viertel", "drei durch vier"}},
      {"de", "IV", {"vier", "der vierte", "dem vierten"}},
      {"fr", "1 234", {"mille deux cent trente-quatre"}},
      {"fr", "1984", {"mille neuf cent quatre-vingt-quatre", "dix-neuf-cent quatre-vingt-quatre"}},
      {"fr", "9:30", {"neuf heures trente", "neuf heures et demie"}},
      {"es", "12,50 €", {"doce euros con cincuenta", "doce coma cincuenta euros"}},
      {"es", "1598", {"mil quinientos noventa y ocho"}},
      {"sv", "25", {"tjugofem"}},
  };
  for (const auto& row : kRows) {
    const auto tokens = tokens_with_readings(row.text, row.language);
    ASSERT_EQ(tokens.size(), 1u) << row.text;
    EXPECT_EQ(tokens[0].text, row.text);
    EXPECT_LE(tokens[0].readings.size(), kMostReadings);
    for (const std::string& way : row.ways) {
      EXPECT_TRUE(std::find(tokens[0].readings.begin(), tokens[0].readings.end(), way) !=
                  tokens[0].readings.end())
          << row.language << " " << row.text << ": " << way << " is not in " << listed(tokens[0]);
    }
  }
}

// The first reading behind what is written is the one that people use.
TEST(TranscriptReadings, RomanceLanguagesSayDecimalsAsANumber) {
  SKIP_WITHOUT_ICU();
  const std::pair<const char*, const char*> kRows[] = {
      {"fr", "trois virgule vingt-cinq"}, {"es", "tres coma veinticinco"},
      {"it", "tre virgola venticinque"},  {"pt", "três vírgula vinte e cinco"},
      {"de", "drei Komma zwei fünf"},     {"nl", "drie komma twee vijf"}};
  for (const auto& [language, first] : kRows) {
    const auto tokens = tokens_with_readings("3,25", language);
    ASSERT_EQ(tokens.size(), 1u) << language;
    ASSERT_GT(tokens[0].readings.size(), 1u) << language;
    EXPECT_EQ(tokens[0].readings[1], first) << language;
  }
}

TEST(Unicode, DatesOfTheCalendar) {
  SKIP_WITHOUT_ICU();
  EXPECT_TRUE(is_date(1, 1, 1) && is_date(9999, 12, 31) && is_date(2000, 2, 29));
  EXPECT_FALSE(is_date(0, 1, 1) || is_date(10000, 1, 1) || is_date(1900, 2, 29));
  EXPECT_FALSE(is_date(2024, 0, 1) || is_date(2024, 13, 1) || is_date(2024, 1, 0));
  EXPECT_FALSE(is_date(2024, 4, 31) || is_date(2023, 2, 29));
}

TEST(TranscriptReadings, TokensAsWritten) {
  SKIP_WITHOUT_ICU();
  const struct {
    const char *language, *text;
    std::vector<std::string> tokens;
  } kRows[] = {
      {"en",
       "In 1984, we paid $500 for 3/4 of it -- 50 % off!",
       {"In", "1984", "we", "paid", "$500", "for", "3/4", "of", "it", "50 %", "off"}},
      {"en",
       "\"Dr. Smith\" (born 5/12/1960) & I don't",
       {"Dr.", "Smith", "born", "5/12/1960", "&", "I", "don't"}},
      {"en", "wait... what?! in 2020 100 men", {"wait", "what", "in", "2020", "100", "men"}},
      {"de",
       "z. B. 12,50 € um 9:30 Uhr, 1 234 Leute",
       {"z. B.", "12,50 €", "um", "9:30 Uhr", "1 234", "Leute"}},
      {"fr", "Il a 1 234 € - 50 %.", {"Il", "a", "1 234 €", "50 %"}},
      {"en", "*** -- ?!", {}},
  };
  for (const auto& row : kRows) {
    std::vector<std::string> tokens;
    for (const Token& token : tokens_with_readings(row.text, row.language)) {
      tokens.push_back(token.text);
    }
    EXPECT_EQ(tokens, row.tokens) << row.text;
  }
}

TEST(TranscriptReadings, OrdinaryWordsHaveNone) {
  SKIP_WITHOUT_ICU();
  for (const Token& token : tokens_with_readings(
           "I don't think well-known people's e-mail, X-ray or a.m. l'été", "en")) {
    EXPECT_TRUE(token.readings.empty()) << token.text << ": " << listed(token);
  }
}

TEST(TranscriptReadings, HostileTokensEnd) {
  SKIP_WITHOUT_ICU();
  const std::string digits(5000, '7');
  const std::vector<std::string> texts = {digits,
                                          "$" + digits,
                                          digits + "/" + digits,
                                          "1,1,1,1,1,1,1",
                                          "$ . % 1 / /2 3/",
                                          "99999999999999999999 %",
                                          "12/99/2024 99:99 0/0 1/0",
                                          "\xF0\x9F\x98\x80 \xE2\x82\xAC \xC2\xBD"};
  for (const std::string& text : texts) {
    for (const Token& token : tokens_with_readings(text, "en")) {
      EXPECT_LE(token.readings.size(), kMostReadings);
      for (const std::string& way : token.readings) EXPECT_LE(way.size(), 300u);
    }
  }
}

}  // namespace transcript_readings_test
}  // namespace animeme::text
