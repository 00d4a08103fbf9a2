#include "tools/speech/text/word_readings.h"

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/chinese.h"
#include "tools/speech/text/japanese.h"
#include "tools/speech/text/spoken_text.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/written.h"

namespace animeme::text {
namespace {

std::string base_of(std::string_view language) {
  return dam::lower_case(language.substr(0, language.find_first_of("-_+")));
}

bool is_japanese(std::string_view language) { return base_of(language) == "ja"; }

bool belongs(char32_t c) {
  const Kind kind = kind_of(c);
  return kind == Kind::letter || kind == Kind::mark || kind == Kind::digit || c == U'\'';
}

}  // namespace

bool has_unparted_words(std::string_view language) {
  const std::string base = base_of(language);
  return unicode_here() && (base == "zh" || base == "cmn" || base == "ja");
}

Result<std::vector<WordReading>> word_readings(std::string_view text, std::string_view language) {
  if (!has_unparted_words(language))
    return std::vector<WordReading>{{std::string(text), std::string(text)}};
  const std::u32string source = code_points(text);
  const bool japanese = is_japanese(language);
  const SpokenText written = read_written(as_written(source), {japanese ? "ja" : "zh"});
  std::u32string unread;
  SpokenText said;
  if (japanese) {
    auto kana = read_japanese(written, unread);
    if (!kana) return kana.error();
    said = *std::move(kana);
  } else {
    said = read_chinese(spell_han_numbers(written, false), unread);
  }
  // What is between blanks and signs is a word; one number may be several readings.
  std::vector<WordReading> words;
  Place last{};
  for (std::size_t i = 0; i < said.size();) {
    if (!belongs(said.text[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < said.size() && belongs(said.text[end])) ++end;
    const Place place = said.place(i, end);
    const std::string reading = utf8(said.text.substr(i, end - i));
    if (!words.empty() && place.first < last.last) {
      words.back().reading += " " + reading;
      last.last = std::max(last.last, place.last);
    } else {
      words.push_back({{}, reading});
      last = place;
    }
    words.back().text = utf8(source.substr(last.first, last.last - last.first));
    i = end;
  }
  return words;
}

}  // namespace animeme::text
