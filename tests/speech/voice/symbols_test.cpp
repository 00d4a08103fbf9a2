#include "tools/speech/voice/symbols.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "dam/script/phones.h"
#include "tools/speech/voice/espeak_ipa.h"
#include "tools/speech/voice/phoneme_table.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {
namespace symbols_test {

// One phoneme of a table in espeak-ng's format.
std::string entry(std::string mnemonic, int place, int code, int type) {
  mnemonic.resize(16, '\0');
  mnemonic[6] = char(place);
  mnemonic[10] = char(code);
  mnemonic[11] = char(type);
  return mnemonic;
}

std::string table(std::string name, int below, const std::vector<std::string>& entries) {
  name.resize(32, '\0');
  std::string bytes = {char(entries.size()), char(below), 0, 0};
  bytes += name;
  for (const std::string& one : entries) bytes += one;
  return bytes;
}

std::string two_tables() {
  return std::string("\x02\0\0\0", 4) +
         table("base", 0, {entry("p", 1, 20, 4), entry("_:", 0, 1, 0), entry("a", 0, 21, 2)}) +
         table("xx", 1, {entry("A", 0, 21, 2), entry("f", 2, 22, 6)});
}

TEST(PhonemeTable, UpperTablesCount) {
  const auto phonemes = read_phoneme_table(two_tables(), "xx");
  ASSERT_TRUE(phonemes) << phonemes.error().describe();
  ASSERT_EQ(phonemes->size(), 3u);
  EXPECT_EQ((*phonemes)[0].mnemonic, "p");
  EXPECT_TRUE((*phonemes)[0].bilabial);
  EXPECT_EQ((*phonemes)[1].mnemonic, "A");
  EXPECT_EQ((*phonemes)[2].mnemonic, "f");
  EXPECT_FALSE((*phonemes)[2].bilabial);
  EXPECT_TRUE(read_phoneme_table(two_tables(), "xx-yy"));
}

TEST(PhonemeTable, DamageIsAnError) {
  const std::string whole = two_tables();
  EXPECT_EQ(read_phoneme_table(whole, "zz").error().code, Code::not_found);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(read_phoneme_table(whole.substr(0, size), "xx").error().code, Code::truncated);
  }
  std::string endless = whole;
  endless[5] = 1;  // base stands on itself
  EXPECT_EQ(read_phoneme_table(endless, "xx").error().code, Code::syntax);
  endless[5] = 9;
  EXPECT_EQ(read_phoneme_table(endless, "xx").error().code, Code::syntax);
}

TEST(PhonemeTable, VoicesNameTheirs) {
  EXPECT_EQ(phoneme_table_name("name X\nlanguage en-gb 2\nlanguage en 3\n"), "en-gb");
  EXPECT_EQ(phoneme_table_name("language en\nphonemes en-us\n"), "en-us");
  EXPECT_EQ(phoneme_table_name(""), "");
}

TEST(EspeakIpa, MeansWhatTheVoiceSays) {
  EXPECT_EQ(meant_ipa("zle/ru", "y"), "ɨ");
  EXPECT_EQ(meant_ipa("zle/ru-LV+f3", "y"), "ɨ");
  EXPECT_EQ(meant_ipa("gmw/de", "yː"), "yː");
  EXPECT_EQ(meant_ipa("gmq/sv", "sx"), "ɧ");
  EXPECT_EQ(meant_ipa("sit/yue", "eoi"), "ɵy");
  EXPECT_EQ(meant_ipa("aav/vi", "yə"), "ɨə");
  EXPECT_EQ(meant_ipa("", ""), "");
}

TEST(EspeakIpa, TheMoraicNOfJapaneseTakesThePlaceOfWhatFollows) {
  EXPECT_EQ(meant_ipa("jpx/ja", "ũ", "p"), "m");
  EXPECT_EQ(meant_ipa("jpx/ja", "ˈũ", "ˈb"), "ˈm");
  EXPECT_EQ(meant_ipa("jpx/ja", "ũ", "dʑ"), "n");
  EXPECT_EQ(meant_ipa("jpx/ja", "ũ", "k"), "ŋ");
  EXPECT_EQ(meant_ipa("jpx/ja", "ũ", "s"), "ɴ");
  EXPECT_EQ(meant_ipa("jpx/ja", "ũ"), "ɴ");
  EXPECT_EQ(meant_ipa("roa/pt", "ũ", "s"), "ũ");
}

std::string joined(const std::vector<std::string>& labels) {
  std::string all;
  for (const std::string& label : labels) all += (all.empty() ? "" : " ") + label;
  return all;
}

TEST(EspeakIpa, JapaneseWordsWithIt) {
  VoiceOptions options;
  options.language = "ja";
  const auto spoken =
      pronounce({"ほんとう", "さんねん", "せんせい", "さんぽ", "かんじ", "さんか"}, options);
  if (!spoken && spoken.error().code == Code::unsupported)
    GTEST_SKIP() << spoken.error().describe();
  ASSERT_TRUE(spoken) << spoken.error().describe();
  // No lip rounding (UW, W) and no closure where no p, b or m follows.
  for (const std::size_t word : {0, 1, 2, 4, 5}) {
    const std::string phones = joined((*spoken)[word]);
    EXPECT_EQ(phones.find("UW"), std::string::npos) << phones;
    EXPECT_EQ(phones.find("M"), std::string::npos) << phones;
  }
  EXPECT_NE(joined((*spoken)[3]).find("M P"), std::string::npos) << joined((*spoken)[3]);
}

std::vector<VoiceSymbol> symbols_of(const char* language) {
  VoiceOptions options;
  options.language = language;
  auto symbols = voice_symbols(options);
  if (!symbols && symbols.error().code == Code::unsupported) return {};
  EXPECT_TRUE(symbols) << language << ": " << symbols.error().describe();
  return symbols ? *std::move(symbols) : std::vector<VoiceSymbol>();
}

std::string phones_of(const std::vector<VoiceSymbol>& symbols, std::string_view mnemonic) {
  for (const VoiceSymbol& symbol : symbols) {
    if (symbol.mnemonic != mnemonic) continue;
    std::string text;
    for (const dam::IpaSound& sound : symbol.sounds) {
      text += (text.empty() ? "" : " ") + std::string(sound.label);
    }
    return text;
  }
  return "not there";
}

// Alone they are at the end of a word, where German has no b and English no short i.
TEST(Symbols, AreWhatTheirNamesSay) {
  const auto german = symbols_of("de");
  if (german.empty()) GTEST_SKIP() << "built without espeak-ng";
  EXPECT_EQ(phones_of(german, "b"), "B");
  EXPECT_EQ(phones_of(german, "d"), "D");
  EXPECT_EQ(phones_of(german, "p"), "P");
  const auto english = symbols_of("en");
  EXPECT_EQ(phones_of(english, "I"), "IH");
  EXPECT_EQ(phones_of(english, "i:"), "IY");
}

TEST(Symbols, EveryLetterOfTheIpaIsSaidSomehow) {
  if (symbols_of("en").empty()) GTEST_SKIP() << "built without espeak-ng";
  const VoiceOptions options;
  std::vector<std::string> replaced;
  for (const char* own : {"pɪˈkɑːn", "θɪŋk", "bɜːd", "ˈlɪtəl"}) {
    EXPECT_NE(mnemonics_of("gmw/en-US", own, options, &replaced), "") << own;
    EXPECT_TRUE(replaced.empty()) << own << ": " << replaced[0];
  }
  const std::string letters = "ʈɖqɢɱɴʙⱱɽɸβʂʐçʝɣχʁħʕɦɬɮʋɻɰɭʎʟʘǀǃǂǁɓɗʄɠʛʍɥʜʢʡɕʑɺɧyɨʉɯʏøɘɵɤœɞɐɶɒɝɚ";
  EXPECT_NE(mnemonics_of("gmw/en-US", letters, options, &replaced), "");
  EXPECT_GT(replaced.size(), 30u);
  for (const std::string& one : replaced) EXPECT_FALSE(one.ends_with("as nothing")) << one;
  replaced.clear();
  EXPECT_NE(mnemonics_of("gmw/en-US", "ʙiː", options, &replaced), "");
  ASSERT_EQ(replaced.size(), 1u);
  EXPECT_TRUE(replaced[0].starts_with("ʙ as ")) << replaced[0];
  EXPECT_EQ(mnemonics_of("gmw/en-US", "%", options), "");
}

TEST(Symbols, LipsOfLanguages) {
  const auto russian = symbols_of("ru");
  if (russian.empty()) GTEST_SKIP() << "built without espeak-ng";
  EXPECT_EQ(phones_of(russian, "y"), "IH");
  EXPECT_EQ(phones_of(symbols_of("sv"), "sx"), "SH");
  EXPECT_EQ(phones_of(symbols_of("tr"), "@"), "IH");
  EXPECT_EQ(phones_of(symbols_of("ja"), "u"), "IH");
  EXPECT_EQ(phones_of(symbols_of("ko"), "u-"), "IH");
  EXPECT_EQ(phones_of(symbols_of("fr"), "y"), "UW");
  EXPECT_EQ(phones_of(symbols_of("hu"), "A"), "AO");
}

// Nothing is unknown, lips close and are rounded where they have to; all voices would take long:
// `animeme phones --all-languages`.
TEST(Symbols, NothingIsUnknown) {
  for (const char* language : {"en", "pl", "cmn", "si", "chr", "ky", "th"}) {
    const auto symbols = symbols_of(language);
    if (symbols.empty()) GTEST_SKIP() << "built without espeak-ng";
    const SymbolCounts counts = count_symbols(symbols);
    EXPECT_GT(counts.exact, 20u) << language;
    EXPECT_EQ(counts.unknown, 0u) << language;
    EXPECT_GT(counts.bilabial, 2u) << language;
    EXPECT_EQ(counts.closed, counts.bilabial) << language;
    EXPECT_EQ(counts.rounded, counts.round) << language;
    EXPECT_EQ(counts.unrounded, counts.flat) << language;
  }
}

}  // namespace symbols_test
}  // namespace animeme::voice
