#include "tools/speech/text/japanese.h"

#include <algorithm>

#include "tools/speech/text/chinese.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

// The vowel of a kana: what a sign for length makes longer. 0: it has none.
char32_t vowel_of(char32_t kana) {
  const char32_t c = kana >= 0x30A1 && kana <= 0x30F6 ? kana - 0x60 : kana;  // as hiragana
  constexpr std::u32string_view kA = U"あかがさざただなはばぱまやゃらわぁ",
                                kI = U"いきぎしじちぢにひびぴみりぃ",
                                kU = U"うくぐすずつづぬふぶぷむゆゅるぅゔ",
                                kE = U"えけげせぜてでねへべぺめれぇ",
                                kO = U"おこごそぞとどのほぼぽもよょろをぉ";
  constexpr std::pair<std::u32string_view, char32_t> kRows[] = {
      {kA, U'ア'}, {kI, U'イ'}, {kU, U'ウ'}, {kE, U'エ'}, {kO, U'オ'}};
  for (const auto& [row, vowel] : kRows) {
    if (row.find(c) != std::u32string_view::npos) return vowel;
  }
  return 0;
}

std::u32string with_long_vowels(std::u32string kana) {
  for (std::size_t i = 1; i < kana.size(); ++i) {
    if (kana[i] != U'ー') continue;
    if (const char32_t vowel = vowel_of(kana[i - 1]); vowel != 0) kana[i] = vowel;
  }
  return kana;
}

}  // namespace

Result<SpokenText> read_japanese(const SpokenText& said, std::u32string& unread,
                                 const std::string& folder) {
  const SpokenText spelled = spell_han_numbers(said, true);
  auto words = japanese_words(spelled.text, folder);
  if (!words) {
    const bool kana = std::none_of(spelled.text.begin(), spelled.text.end(),
                                   [](char32_t c) { return script_of(c) == "Hani"; });
    if (!kana) return words.error();
    SpokenText out = spelled;
    out.text = with_long_vowels(out.text);
    return out;
  }
  SpokenText out;
  std::size_t at = 0;
  for (const JapaneseWord& word : *words) {
    out.add(spelled, at, word.first);
    at = word.last;
    const Place place = spelled.place(word.first, word.last);
    const bool reads = is_letter_or_digit(spelled.text[word.first]);
    // は behind a word in Latin letters would be spelled with it.
    const bool leans = word.leans && !out.text.empty() && script_of(out.text.back()) != "Latn";
    if (reads && !leans && !out.text.empty() && is_letter_or_digit(out.text.back())) {
      out.add(U" ", {place.first, place.first});
    }
    if (!word.kana.empty()) {
      out.add(with_long_vowels(word.kana), place);
    } else if (script_of(spelled.text[word.first]) == "Hani") {
      unread.append(spelled.text, word.first, word.last - word.first);
    } else {
      out.add(spelled, word.first, word.last);
    }
  }
  out.add(spelled, at, spelled.size());
  return out;
}

}  // namespace animeme::text
