#include "tools/speech/text/passages.h"

#include <algorithm>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/guess.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/text/written.h"

namespace animeme::text {
namespace {

constexpr std::size_t kNobody = std::size_t(-1);
constexpr std::size_t kShown = 30;  // characters of a text that is refused

// Of letters and what belongs to them; empty for what has no script.
std::string script_at(const SpokenText& said, std::size_t at) {
  const Kind kind = kind_of(said.text[at]);
  if (kind != Kind::letter && kind != Kind::mark) return {};
  std::string script = script_of(said.text[at]);
  if (script == "Zyyy" || script == "Zinh" || script == "Zzzz") return {};
  return script;
}

class Parting {
 public:
  Parting(const SpokenText& said, Speakers& speakers) : said_(said), speakers_(speakers) {}

  Result<std::vector<Passage>> part() {
    owner_.assign(said_.size(), kNobody);
    guess_latin();
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

  // The language of each sentence in Latin letters, where there is a choice.
  void guess_latin() {
    const auto& list = speakers_.list;
    const auto readers = std::count_if(list.begin(), list.end(),
                                       [&](const Speaker& one) { return reads(one, "Latn"); });
    guessed_.assign(said_.size(), {});
    if (!speakers_.by_words || (!speakers_.automatic && readers < 2)) return;
    std::u32string latin = said_.text;
    for (std::size_t i = 0; i < latin.size(); ++i) {
      const std::string script = script_at(said_, i);
      if (!script.empty() && script != "Latn") latin[i] = U' ';
    }
    guessed_ = guess_sentences(latin);
  }

  // The voice of a language, which is added if it may be; nothing if there is none.
  std::optional<std::size_t> speaker_of(const std::string& language, const std::string& script) {
    std::vector<Speaker>& list = speakers_.list;
    if (language.empty()) return std::nullopt;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (main_language(list[i].language) == language && reads(list[i], script)) return i;
    }
    if (!speakers_.automatic || !speakers_.find) return std::nullopt;
    auto found = speakers_.find(language);
    if (!found || !reads(*found, script)) return std::nullopt;
    list.push_back(*std::move(found));
    return list.size() - 1;
  }

  Result<std::size_t> speaker_for(const std::string& script, std::size_t first, std::size_t last) {
    std::vector<Speaker>& list = speakers_.list;
    if (script == "Latn") {
      if (const auto known = speaker_of(guessed_[first], script)) return *known;
    }
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

  const SpokenText& said_;
  Speakers& speakers_;
  std::vector<std::size_t> owner_;
  std::vector<std::string> guessed_;  // of each character; empty: not sure, or not asked
};

}  // namespace

Result<std::vector<Passage>> part_passages(const SpokenText& said, Speakers& speakers) {
  if (said.size() == 0) return std::vector<Passage>();
  return Parting(said, speakers).part();
}

}  // namespace animeme::text
