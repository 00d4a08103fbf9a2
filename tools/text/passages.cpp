#include "tools/text/passages.h"

#include <algorithm>
#include <cstdlib>
#include <set>

#include "dam/script/script_text_internal.h"
#include "tools/text/unicode.h"
#include "tools/text/written.h"

namespace animeme::text {
namespace {

constexpr std::size_t kNobody = std::size_t(-1);
constexpr std::size_t kShown = 30;  // characters of a text that is refused

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

std::string first_part(std::string_view language) {
  return dam::lower_case(language.substr(0, language.find_first_of("-_+")));
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

// Of letters and what belongs to them; empty for what has no script.
std::string script_at(const Said& said, std::size_t at) {
  const Kind kind = kind_of(said.text[at]);
  if (kind != Kind::letter && kind != Kind::mark) return {};
  std::string script = script_of(said.text[at]);
  if (script == "Zyyy" || script == "Zinh" || script == "Zzzz") return {};
  return script;
}

class Parting {
 public:
  Parting(const Said& said, Speakers& speakers) : said_(said), speakers_(speakers) {}

  Result<std::vector<Passage>> part() {
    owner_.assign(said_.size(), kNobody);
    for (std::size_t i = 0; i < said_.size();) {
      const std::size_t end = run_end(i);
      const std::string script = script_at(said_, i);
      if (!script.empty() && !(script == "Latn" && is_unit(said_.text, i, end))) {
        const auto speaker = speaker_for(script, i, end);
        if (!speaker) return speaker.error();
        std::fill(owner_.begin() + std::ptrdiff_t(i), owner_.begin() + std::ptrdiff_t(end),
                  *speaker);
      }
      i = end;
    }
    fill_gaps();
    std::vector<Passage> passages;
    for (std::size_t i = 0; i < said_.size(); ++i) {
      if (passages.empty() || passages.back().speaker != owner_[i]) {
        passages.push_back({{}, owner_[i]});
      }
      passages.back().said.add(said_, i, i + 1);
    }
    return passages;
  }

 private:
  // Letters of one script in a row, with their marks; else one character.
  std::size_t run_end(std::size_t first) const {
    const std::string script = script_at(said_, first);
    std::size_t end = first + 1;
    if (script.empty()) return end;
    while (end < said_.size()) {
      const std::string next = script_at(said_, end);
      if (next != script && !(next.empty() && kind_of(said_.text[end]) == Kind::mark)) break;
      ++end;
    }
    return end;
  }

  bool reads(const Speaker& speaker, std::string_view script) const {
    return speaker.scripts.empty() || std::find(speaker.scripts.begin(), speaker.scripts.end(),
                                                script) != speaker.scripts.end();
  }

  Result<std::size_t> speaker_for(const std::string& script, std::size_t first, std::size_t last) {
    std::vector<Speaker>& list = speakers_.list;
    // A voice that was found for one language of a script has the others of it, too.
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (reads(list[i], script)) return i;
    }
    const bool latin = script == "Latn";
    if (latin && list[0].latin_by_itself && !speakers_.automatic) return std::size_t(0);
    if (script == "Grek" && last - first == 1) return std::size_t(0);
    if ((speakers_.automatic || latin) && speakers_.find) {
      const std::string language = latin ? "en" : language_for(script, said_.text);
      if (auto found = speakers_.find(language); !language.empty() && found) {
        if (reads(*found, script)) {
          list.push_back(*std::move(found));
          return list.size() - 1;
        }
      }
    }
    return refused(script, first, last);
  }

  Error refused(const std::string& script, std::size_t first, std::size_t last) const {
    // Words of the script with what is between them.
    std::size_t end = last;
    for (std::size_t i = last; i < said_.size() && i - first < kShown; ++i) {
      const std::string next = script_at(said_, i);
      if (!next.empty() && next != script) break;
      if (next == script) end = i + 1;
    }
    const std::string shown = utf8(said_.text.substr(first, std::min(end - first, kShown)));
    const bool ideas = script == "Hani";
    std::string text = "\"" + shown + "\" has " + script_name(script) +
                       (ideas ? " characters" : " letters") + ", which the voice " +
                       speakers_.list[0].name + " does not speak: ";
    const std::string language = language_for(script, said_.text);
    const bool voiced =
        !language.empty() && (!speakers_.find || speakers_.find(language).has_value());
    if (!voiced)
      return make_error(Code::invalid_argument, text + "espeak-ng has no voice for them");
    const bool either = ideas && language == "zh";
    text += "--lang " + language + (either ? " (Japanese: ja)" : "") + ", or --lang " +
            speakers_.list[0].language + "+" + language;
    return make_error(Code::invalid_argument, text);
  }

  // Digits and signs go with the letters that they touch, or that are on both sides.
  void fill_gaps() {
    for (std::size_t i = 0; i < owner_.size();) {
      if (owner_[i] != kNobody) {
        ++i;
        continue;
      }
      std::size_t end = i;
      while (end < owner_.size() && owner_[end] == kNobody) ++end;
      const std::size_t before = i > 0 ? owner_[i - 1] : kNobody;
      const std::size_t after = end < owner_.size() ? owner_[end] : kNobody;
      const bool words = has_words(std::u32string_view(said_.text).substr(i, end - i));
      std::size_t whose = 0;
      if (before == after || (!words && before != kNobody)) {
        whose = before == kNobody ? 0 : before;
      } else if (before == kNobody && !words) {
        whose = after;
      } else if (before != kNobody && touches(i)) {
        whose = before;
      } else if (after != kNobody && touches(end)) {
        whose = after;
      }
      std::fill(owner_.begin() + std::ptrdiff_t(i), owner_.begin() + std::ptrdiff_t(end), whose);
      i = end;
    }
  }

  // A digit and a letter without a blank between: MP3, 3個.
  bool touches(std::size_t border) const {
    const char32_t a = said_.text[border - 1], b = said_.text[border];
    return (is_letter(a) && kind_of(b) == Kind::digit) ||
           (kind_of(a) == Kind::digit && is_letter(b));
  }

  const Said& said_;
  Speakers& speakers_;
  std::vector<std::size_t> owner_;
};

}  // namespace

Speaker make_speaker(std::string language, std::string voice, std::string name) {
  Speaker speaker{std::move(language), std::move(voice), std::move(name)};
  const std::string code = dam::lower_case(speaker.language);
  speaker.scripts = scripts_of_language(code);
  for (const Extra& extra : kExtras) {
    const bool same = extra.language == code || extra.language == first_part(code);
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
                                  first_part(code)) == std::end(kWithoutDigits);
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
  // The one whose alphabet lacks the fewest of them: CLDR's Urdu has no آ.
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
    if (unknown < fewest) best = &language;
    fewest = std::min(fewest, unknown);
  }
  return *best;
}

std::string first_language(std::u32string_view text) {
  for (const char32_t c : text) {
    const std::string script = is_letter(c) ? script_of(c) : std::string();
    if (script.empty() || script == "Zyyy" || script == "Zinh") continue;
    return script == "Latn" ? std::string() : language_for(script, text);
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

Result<std::vector<Passage>> part_passages(const Said& said, Speakers& speakers) {
  if (said.size() == 0) return std::vector<Passage>();
  return Parting(said, speakers).part();
}

}  // namespace animeme::text
