#include <algorithm>
#include <cstdlib>
#include <set>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/guess.h"
#include "tools/speech/text/passages.h"
#include "tools/speech/text/unicode.h"

namespace animeme::text {
namespace {

// Scripts beside that of the locale, or where CLDR has none, of the voices of espeak-ng 1.51: each
// was given a word in each script.
struct Extra {
  std::string_view language, scripts;
};
constexpr Extra kExtras[] = {
    {"sr", "Cyrl Latn"},
    {"hr", "Latn Cyrl"},
    {"bs", "Latn Cyrl"},
    {"mk", "Cyrl Latn"},
    {"uz", "Latn Cyrl"},
    {"ug", "Arab Latn"},
    {"grc", "Grek Latn"},
    {"lfn", "Latn Cyrl"},
    {"fa-latn", "Latn Arab"},
    {"nog", "Cyrl"},
    {"cmn-latn-pinyin", "Latn Hani"},
    {"yue", "Hani"},
    {"yue-latn-jyutping", "Latn Hani"},
    {"hak", "Latn"},
    {"chr", "Cher"},
    {"piqd", "Latn"},
    {"py", "Latn"},
    {"qdb", "Latn"},
    {"qya", "Latn"},
    {"sjn", "Latn"},
    {"nci", "Latn"},
    {"ltg", "Latn"},
    {"smj", "Latn"},
    {"io", "Latn"},
    {"jbo", "Latn"},
};

std::vector<std::string> split(std::string_view names) {
  std::vector<std::string> out;
  while (!names.empty()) {
    const std::size_t blank = std::min(names.find(' '), names.size());
    out.emplace_back(names.substr(0, blank));
    names.remove_prefix(std::min(blank + 1, names.size()));
  }
  return out;
}

// Languages of a script, the usual one first, where letters tell them apart.
std::vector<std::string> languages_of(std::string_view script) {
  if (script == "Cyrl") return split("ru uk bg be sr mk kk ky tt ba cv");
  if (script == "Arab") return split("ar fa ur sd ug");
  if (script == "Deva") return split("hi mr ne kok");
  if (script == "Beng") return split("bn as");
  const std::string one = language_of_script(script);
  return one.empty() ? std::vector<std::string>() : std::vector<std::string>{one};
}

}  // namespace

std::string main_language(std::string_view tag) {
  return dam::lower_case(tag.substr(0, tag.find_first_of("-_+")));
}

Speaker make_speaker(std::string language, std::string voice, std::string name) {
  Speaker speaker{std::move(language), std::move(voice), std::move(name)};
  const std::string code = dam::lower_case(speaker.language);
  speaker.scripts = scripts_of_language(code);
  for (const Extra& extra : kExtras) {
    const bool same = extra.language == code || extra.language == main_language(code);
    if (same && (extra.language == code || code.find("latn") == std::string::npos)) {
      speaker.scripts = split(extra.scripts);
    }
  }
  if (!unicode_here()) speaker.scripts.clear();
  const bool mandarin = code == "cmn" || code == "zh" || code == "cmn-latn-pinyin";
  if (mandarin && unicode_here()) speaker.letters = Letters::pinyin;
  if (code == "ja" && unicode_here()) speaker.letters = Letters::kana;
  const auto& scripts = speaker.scripts;
  const bool latin = std::find(scripts.begin(), scripts.end(), "Latn") != scripts.end();
  speaker.latin_by_itself = !latin && speaker.letters == Letters::as_written;
  constexpr std::string_view kWithoutDigits[] = {"he", "cv", "chr", "nog", "qya", "sjn", "tk"};
  speaker.says_digits = std::find(std::begin(kWithoutDigits), std::end(kWithoutDigits),
                                  main_language(code)) == std::end(kWithoutDigits);
  return speaker;
}

std::string language_for(std::string_view script, std::u32string_view text) {
  if (script == "Hani") {
    const bool kana = std::any_of(text.begin(), text.end(), [](char32_t c) {
      const std::string own = script_of(c);
      return own == "Hira" || own == "Kana";
    });
    return kana ? "ja" : "zh";
  }
  const std::vector<std::string> languages = languages_of(script);
  if (languages.size() < 2) return languages.empty() ? std::string() : languages.front();
  std::set<char32_t> used;
  for (const char32_t c : text) {
    if (is_letter(c) && script_of(c) == script) used.insert(c);
  }
  // The one whose alphabet lacks the fewest of them: CLDR's Urdu has no آ. Of several the one that
  // the words are in.
  const std::string guessed = guess_language(text);
  const std::string* best = &languages.front();
  auto fewest = std::ptrdiff_t(used.size()) + 1;
  for (const std::string& language : languages) {
    std::set<char32_t> known;
    for (const std::u32string& letter : letters_of_language(language)) {
      known.insert(letter.begin(), letter.end());
    }
    const auto unknown = std::count_if(used.begin(), used.end(), [&](char32_t c) {
      return !known.contains(c) && !known.contains(lower(c));
    });
    if (unknown < fewest || (unknown == fewest && language == guessed)) best = &language;
    fewest = std::min(fewest, unknown);
  }
  return *best;
}

std::string first_language(std::u32string_view text) {
  for (const char32_t c : text) {
    const std::string script = is_letter(c) ? script_of(c) : std::string();
    if (script.empty() || script == "Zyyy" || script == "Zinh") continue;
    return script == "Latn" ? guess_language(text) : language_for(script, text);
  }
  return {};
}

std::string locale_language() {
  for (const char* name : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    const char* value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    std::string language(value);
    language.resize(std::min(language.find_first_of(".@"), language.size()));
    std::replace(language.begin(), language.end(), '_', '-');
    return language == "C" || language == "POSIX" ? "en" : language;
  }
  return "en";
}

}  // namespace animeme::text
