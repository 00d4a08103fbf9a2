#include "tools/speech/voice/espeak_ipa.h"

#include <initializer_list>

#include "dam/script/script_text_internal.h"

namespace animeme::voice {
namespace {

struct Correction {
  std::string_view language;  ///< as the identifier begins, without region
  std::string_view written, meant;
};

// Of espeak-ng 1.51. Found by comparing what each voice writes with the sounds of its language.
constexpr Correction kCorrections[] = {
    // No vowel of these is front and rounded.
    {"ru", "y", "ɨ"},
    {"uk", "y", "ɨ"},
    {"be", "y", "ɨ"},
    {"vi", "y", "ɨ"},
    {"gn", "y", "ɨ"},
    {"pt", "y", "ɨ"},
    {"et", "ɵ", "ɤ"},   // õ
    {"ta", "ʉ", "ɯ"},   // the short u at the end of words
    {"hu", "ɑ", "ɒ"},   // a, which is rounded
    {"fa", "ɑ", "ɒ"},   // long a, the same
    {"sv", "sx", "ɧ"},  // sju
    {"ky", "oe", "ø"},
    {"om", "?", "j"},
    {"de", "??", "ʊɐ"},
    {"de", "i?", "iɐ"},
    {"bg", "\x01", "dʑ"},
    // Pinyin and Jyutping.
    {"cmn", "nɡ", "ŋ"},
    {"hak", "nɡ", "ŋ"},
    {"my", "nɡ", "ŋ"},
    {"yue", "nɡ", "ŋ"},
    {"yue", "aa", "aː"},
    {"yue", "oe", "œ"},
    {"yue", "eoi", "ɵy"},
    {"yue", "eo", "ɵ"},
    {"yue", "yu", "y"},
    {"yue", "c", "tsʰ"},
    {"yue", "z", "ts"},
};

std::string language_of(std::string_view voice) {
  voice.remove_prefix(voice.rfind('/') + 1);
  return dam::lower_case(voice.substr(0, voice.find_first_of("-+")));
}

constexpr std::string_view kNasalU = "\u0169";

// The moraic n of Japanese takes the place of what follows.
std::string_view moraic_n(std::string_view next) {
  std::size_t at = 0;
  while (next.substr(at).starts_with("ˈ") || next.substr(at).starts_with("ˌ")) {
    at += std::string_view("ˈ").size();
  }
  next.remove_prefix(at);
  const auto begins = [&](std::initializer_list<std::string_view> sounds) {
    for (const std::string_view sound : sounds) {
      if (next.starts_with(sound)) return true;
    }
    return false;
  };
  if (begins({"p", "b", "m"})) return "m";
  if (begins({"t", "d", "n", "ɾ", "ɽ", "r", "l"})) return "n";
  if (begins({"k", "g", "ɡ", "ŋ"})) return "ŋ";
  return "ɴ";
}

}  // namespace

std::string_view ipa_behind(const std::vector<VoiceEvent>& events, std::size_t at) {
  for (std::size_t i = at + 1; i < events.size(); ++i) {
    if (events[i].kind == EventKind::phoneme && !events[i].ipa.empty()) return events[i].ipa;
  }
  return {};
}

std::string meant_ipa(std::string_view voice, std::string_view written, std::string_view next) {
  const std::string language = language_of(voice);
  std::string out;
  for (std::string_view rest = written; !rest.empty();) {
    if (language == "ja" && rest.starts_with(kNasalU)) {
      rest.remove_prefix(kNasalU.size());
      out += moraic_n(rest.empty() ? next : rest);
      continue;
    }
    const Correction* best = nullptr;
    for (const Correction& row : kCorrections) {
      const bool fits = row.language == language && rest.starts_with(row.written);
      if (fits && (best == nullptr || row.written.size() > best->written.size())) best = &row;
    }
    out += best != nullptr ? best->meant : rest.substr(0, 1);
    rest.remove_prefix(best != nullptr ? best->written.size() : 1);
  }
  return out;
}

}  // namespace animeme::voice
