#include "tools/speech/voice/voice_choice.h"

#include <algorithm>

#include "dam/script/script_text_internal.h"
#include "tools/formats/media/language_codes.h"
#include "tools/speech/text/passages.h"
#include "tools/speech/text/unicode.h"

namespace animeme::voice {
namespace {

using dam::lower_case;

std::string file_name(const std::string& identifier) {
  return identifier.substr(identifier.rfind('/') + 1);
}

// What selects a voice, best first: its own language, name and files, then other languages.
const VoiceInfo* find_exactly(const std::string& wanted, const std::vector<VoiceInfo>& voices) {
  const auto first = [&](auto matches) -> const VoiceInfo* {
    const auto found = std::find_if(voices.begin(), voices.end(), matches);
    return found == voices.end() ? nullptr : &*found;
  };
  if (auto voice = first([&](auto& v) { return lower_case(v.language) == wanted; })) return voice;
  if (auto voice = first([&](auto& v) { return lower_case(v.name) == wanted; })) return voice;
  if (auto voice = first([&](auto& v) {
        return lower_case(v.identifier) == wanted || lower_case(file_name(v.identifier)) == wanted;
      })) {
    return voice;
  }
  return first([&](auto& v) {
    return std::any_of(v.other_languages.begin(), v.other_languages.end(),
                       [&](const std::string& code) { return lower_case(code) == wanted; });
  });
}

// "de" for "deu"; empty: no voice has that language.
std::string language_of_code(const std::string& code, const std::vector<VoiceInfo>& voices) {
  const auto found = std::find_if(voices.begin(), voices.end(), [&](const VoiceInfo& voice) {
    return text::language_code(voice.language) == code;
  });
  return found == voices.end() ? std::string() : text::main_language(found->language);
}

const VoiceInfo* find_voice(std::string wanted, const std::vector<VoiceInfo>& voices) {
  std::replace(wanted.begin(), wanted.end(), '_', '-');
  for (;;) {
    const VoiceInfo* american = wanted == "en" ? find_exactly("en-us", voices) : nullptr;
    if (american != nullptr) return american;
    if (const VoiceInfo* voice = find_exactly(wanted, voices)) return voice;
    const std::size_t dash = wanted.rfind('-');  // "de-at": try "de"
    if (dash == std::string::npos) break;
    wanted.resize(dash);
  }
  if (wanted.size() != 3) return nullptr;
  const std::string main = language_of_code(media::terminological_code(wanted), voices);
  return main.empty() || main == wanted ? nullptr : find_voice(main, voices);
}

std::size_t common_prefix(std::string_view a, std::string_view b) {
  std::size_t count = 0;
  while (count < a.size() && count < b.size() && a[count] == b[count]) ++count;
  return count;
}

// Alike: many common leading letters in code or name, then similar length.
std::string nearest(const std::string& wanted, const std::vector<VoiceInfo>& voices) {
  std::vector<std::pair<std::size_t, const VoiceInfo*>> ranked;
  for (const VoiceInfo& voice : voices) {
    const std::size_t alike = std::max(common_prefix(wanted, lower_case(voice.language)),
                                       common_prefix(wanted, lower_case(voice.name)));
    ranked.emplace_back(alike, &voice);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string names;
  for (std::size_t i = 0; i < std::min<std::size_t>(4, ranked.size()); ++i) {
    names += (names.empty() ? "" : ", ") + ranked[i].second->language + " (" +
             ranked[i].second->name + ")";
  }
  return names;
}

}  // namespace

Result<ChosenVoice> choose_voice(std::string_view language, std::string_view variant,
                                 const VoiceLists& lists) {
  const std::string base = lower_case(language.substr(0, 100));
  const VoiceInfo* voice = find_voice(base, lists.voices);
  if (lists.voices.empty()) {
    return make_error(Code::not_found,
                      "espeak-ng has no voices; install the Debian package espeak-ng-data again");
  }
  if (voice == nullptr) {
    return make_error(Code::not_found, "no voice \"" + base + "\"; the nearest are " +
                                           nearest(base, lists.voices) +
                                           "; espeak-ng --voices lists all");
  }
  return ChosenVoice{voice->identifier + std::string(variant), voice->name, voice->language};
}

Result<ChosenVoices> choose_voices(std::string_view wanted, const VoiceLists& lists) {
  std::vector<std::string> parts(1);
  for (const char c : lower_case(wanted.substr(0, 100))) {
    if (c == '+') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  ChosenVoices chosen;
  std::vector<std::string> languages;
  for (const std::string& part : parts) {
    if (part == "auto") {
      chosen.automatic = true;
      continue;
    }
    if (&part == &parts.front() || find_voice(part, lists.voices) != nullptr) {
      languages.push_back(part);
      continue;
    }
    const auto known = std::find_if(lists.variants.begin(), lists.variants.end(),
                                    [&](const std::string& v) { return lower_case(v) == part; });
    if (known == lists.variants.end()) {
      return make_error(Code::not_found,
                        "no language and no voice variant \"" + part +
                            "\"; espeak-ng --voices and espeak-ng --voices=variant list all");
    }
    if (chosen.variant.empty()) chosen.variant = "+" + *known;
  }
  for (const std::string& language : languages) {
    auto voice = choose_voice(language, chosen.variant, lists);
    if (!voice) return voice.error();
    chosen.voices.push_back(*std::move(voice));
  }
  return chosen;
}

}  // namespace animeme::voice
