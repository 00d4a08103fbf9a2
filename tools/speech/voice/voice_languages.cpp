#include "tools/speech/voice/voice_languages.h"

#include <algorithm>
#include <cstdlib>
#include <set>

#include "dam/script/phones.h"
#include "dam/script/script_text_internal.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/voice/espeak_ipa.h"
#include "tools/speech/voice/transcript.h"
#include "tools/speech/voice/voice_events.h"

namespace animeme::voice {
namespace {

// "(en-us)" is "en-us".
std::string changed_to(std::string_view ipa) {
  ipa.remove_prefix(1);
  return std::string(ipa.substr(0, ipa.find(')')));
}

std::size_t speaker_at(std::int32_t position, const text::Utterance& utterance) {
  const auto at = std::size_t(std::max(position - 1, 0));
  std::size_t speaker = 0;
  for (const text::Stretch& stretch : utterance.stretches) {
    if (stretch.first <= at) speaker = stretch.speaker;
  }
  return speaker;
}

// A language that is being put together.
struct Open {
  SpokenLanguage language;
  text::Place place;
  std::size_t speaker = 0;
};

void widen(text::Place& place, text::Place more) {
  if (more.last <= more.first) return;
  place.first = place.last == 0 ? more.first : std::min(place.first, more.first);
  place.last = std::max(place.last, more.last);
}

std::string text_of(text::Place place, const text::Utterance& utterance) {
  const std::string all =
      text::utf8(utterance.source.substr(place.first, place.last - place.first));
  return std::string(dam::trimmed(all));
}

bool is_foreign(std::string_view text) {
  const std::u32string code = text::code_points(text);
  return std::any_of(code.begin(), code.end(), [](char32_t c) {
    return text::kind_of(c) == text::Kind::letter && c >= 0x80 && text::script_of(c) != "Latn";
  });
}

}  // namespace

std::vector<SpokenLanguage> find_languages(const RawSpeech& raw, int sample_rate,
                                           const text::Utterance& utterance) {
  std::vector<Open> parts;
  const double rate = sample_rate;
  if (utterance.speakers.empty()) return {};
  text::Place word;
  std::size_t speaker = 0;
  std::string foreign;  // the language that the voice changed to by itself
  const auto begin = [&](double seconds) {
    const text::Speaker& who = utterance.speakers[speaker];
    const bool same = !parts.empty() && parts.back().speaker == speaker &&
                      parts.back().language.by_itself == !foreign.empty() &&
                      (foreign.empty() || parts.back().language.language == foreign);
    if (!same) {
      if (!parts.empty()) parts.back().language.end = seconds;
      Open part;
      part.speaker = speaker;
      part.language = {seconds,
                       seconds,
                       foreign.empty() ? who.language : foreign,
                       foreign.empty() ? who.name : "espeak-ng's " + foreign,
                       {},
                       !foreign.empty()};
      parts.push_back(std::move(part));
    }
    widen(parts.back().place, word);
  };
  bool fresh = false;  // a word whose first sound has not come yet
  for (const VoiceEvent& event : raw.events) {
    if (event.kind == EventKind::word) {
      if (utterance.markup && event.text_length == 0) continue;
      word = place_of(event, utterance);
      const std::size_t next = speaker_at(event.text_position, utterance);
      if (next != speaker) foreign.clear();
      speaker = next;
      fresh = true;
    } else if (event.kind == EventKind::phoneme) {
      if (event.ipa.starts_with('(')) {
        const std::string to = changed_to(event.ipa);
        const bool home =
            text::main_language(to) == text::main_language(utterance.speakers[speaker].language);
        foreign = home ? std::string() : to;
      } else if (fresh && !event.ipa.empty() && !event.ipa.starts_with('_')) {
        begin(double(event.sample) / rate);
        fresh = false;
      }
    }
  }
  std::vector<SpokenLanguage> out;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Open& part = parts[i];
    // With what follows the last word that the voice told of: "-vous" of "allez-vous", "?".
    const auto next =
        i + 1 < parts.size() ? parts[i + 1].place.first : std::uint32_t(utterance.source.size());
    part.place.last = std::max(part.place.last, next);
    part.language.text = text_of(part.place, utterance);
    out.push_back(std::move(part.language));
  }
  if (!out.empty()) out.back().end = double(raw.silent.size()) / rate;
  return out;
}

std::vector<SpeechMark> find_marks(const RawSpeech& raw, int sample_rate,
                                   const text::Utterance& utterance) {
  std::vector<SpeechMark> marks;
  for (const VoiceEvent& event : raw.events) {
    if (event.kind != EventKind::mark) continue;
    const auto number = std::size_t(std::strtoul(event.ipa.c_str(), nullptr, 10));
    if (number >= utterance.marks.size()) continue;
    const double time = double(event.sample) / sample_rate + utterance.mark_shifts[number];
    marks.push_back({time, utterance.marks[number]});
  }
  return marks;
}

std::string warn_of_letters(const RawSpeech& raw, const text::Utterance& utterance,
                            const std::vector<SpokenLanguage>& languages) {
  std::vector<std::string> words;
  std::set<std::string> known;
  const auto add = [&](const std::string& word) {
    if (known.insert(word).second) words.push_back(word);
  };
  for (const SpokenLanguage& part : languages) {
    if (part.by_itself && is_foreign(part.text)) add(part.text);
  }
  // Spelled words and numbers are several events with one position.
  const VoiceEvent* before = nullptr;
  for (const VoiceEvent& event : raw.events) {
    if (event.kind != EventKind::word) continue;
    const bool again =
        before != nullptr && before->text_position == event.text_position && event.text_length > 0;
    before = &event;
    if (!again) continue;
    const text::Place place = place_of(event, utterance);
    const auto at = std::size_t(std::max(event.text_position - 1, 0));
    const bool as_it_is = place.last - place.first == std::uint32_t(event.text_length) &&
                          at < utterance.input.size() &&
                          utterance.input.text[at] == utterance.source[place.first];
    const std::string word(strip_punctuation(text_of(place, utterance)));
    const std::u32string letters = text::code_points(word);
    const bool digits = std::any_of(letters.begin(), letters.end(), [](char32_t c) {
      return text::kind_of(c) == text::Kind::digit;
    });
    if (as_it_is && !digits && is_foreign(word)) add(word);
  }
  if (words.empty()) return {};
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(words.size(), 5); ++i) {
    text += (i > 0 ? ", \"" : "\"") + words[i] + "\"";
  }
  if (words.size() > 5) text += " and " + std::to_string(words.size() - 5) + " more";
  return text +
         ": letters that the voice does not know are spoken by name or in another language; select "
         "a voice for their language (--lang)";
}

std::string warn_of_missing_vowels(const dam::Script& script, const std::string& voice) {
  // The names of months and days in 71 languages: Hebrew has 0.09, all others 0.43 to 1.2.
  constexpr double kLeastVowels = 0.33;  // per consonant
  constexpr std::size_t kEnoughConsonants = 10;
  const auto& phones = script.phones;
  const auto is_vowel = [&](std::size_t i) {
    const dam::PhoneInfo* info = i < phones.size() ? dam::find_phone(phones[i].label) : nullptr;
    return info != nullptr && info->vowel;
  };
  std::size_t vowels = 0, consonants = 0;
  for (std::size_t i = 0; i < phones.size(); ++i) {
    if (phones[i].label == dam::kSilence) continue;
    const bool carries =
        is_vowel(i) || (phones[i].label == "R" && !(i > 0 && is_vowel(i - 1)) && !is_vowel(i + 1));
    ++(carries ? vowels : consonants);
  }
  if (consonants < kEnoughConsonants || double(vowels) >= kLeastVowels * double(consonants)) {
    return {};
  }
  return "the voice " + voice + " speaks this text with hardly any vowels (" +
         std::to_string(vowels) + " beside " + std::to_string(consonants) +
         " consonants), so it is not intelligible: write the vowels (points), or use another voice "
         "(--tts)";
}

std::vector<VowelSign> vowel_signs(std::u32string_view text) {
  constexpr std::size_t kMostSigns = 24;
  std::vector<VowelSign> signs;
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (!text::is_vowel_sign(text[i]) || !text::is_letter(text[i - 1])) continue;
    const std::string sign = text::utf8(text.substr(i, 1));
    const auto known = std::find_if(signs.begin(), signs.end(),
                                    [&](const VowelSign& one) { return one.sign == sign; });
    if (known == signs.end()) {
      signs.push_back({text::utf8(text.substr(i - 1, 2)), sign, 1});
    } else {
      ++known->count;
    }
  }
  std::stable_sort(signs.begin(), signs.end(),
                   [](const VowelSign& a, const VowelSign& b) { return a.count > b.count; });
  if (signs.size() > kMostSigns) signs.resize(kMostSigns);
  return signs;
}

std::string warn_of_vowel_signs(const std::vector<VowelSign>& signs,
                                const std::vector<std::vector<std::string>>& phones,
                                const std::string& voice) {
  constexpr std::size_t kFewOf = 20;  // one of so many is let pass
  std::size_t all = 0, lost = 0;
  std::string list;
  for (std::size_t i = 0; i < std::min(signs.size(), phones.size()); ++i) {
    all += signs[i].count;
    const bool spoken = std::any_of(phones[i].begin(), phones[i].end(), [](const auto& label) {
      const dam::PhoneInfo* info = dam::find_phone(label);
      return info != nullptr && info->vowel;
    });
    if (spoken) continue;
    lost += signs[i].count;
    list += (list.empty() ? "" : ", ") + signs[i].syllable;
  }
  if (lost * kFewOf <= all) return {};
  return "the voice " + voice + " speaks " + std::to_string(lost) + " of " + std::to_string(all) +
         " vowel signs of this text without a vowel (" + list +
         "), so it is not intelligible: use another voice (--tts)";
}

void correct_ipa(RawSpeech& raw, const text::Utterance& utterance) {
  std::size_t speaker = 0;
  for (std::size_t i = 0; i < raw.events.size(); ++i) {
    VoiceEvent& event = raw.events[i];
    if (event.kind == EventKind::word && event.text_length > 0) {
      speaker = speaker_at(event.text_position, utterance);
    }
    if (event.kind == EventKind::phoneme && speaker < utterance.speakers.size()) {
      event.ipa =
          meant_ipa(utterance.speakers[speaker].voice, event.ipa, ipa_behind(raw.events, i));
    }
  }
}

}  // namespace animeme::voice
