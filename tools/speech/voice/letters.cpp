#include "tools/speech/voice/letters.h"

#include <algorithm>

#include "tools/speech/text/unicode.h"
#include "tools/speech/voice/voice_job.h"
#include "tools/speech/voice/voice_languages.h"

namespace animeme::voice {
namespace {

constexpr std::size_t kMostLetters = 400;

// A letter that marks can stand behind.
std::u32string carrier_of(const std::vector<std::u32string>& letters) {
  for (const std::u32string& letter : letters) {
    if (letter.size() == 1 && text::is_letter(letter[0])) return letter;
  }
  return {};
}

bool says_something(const RawSpeech& raw) {
  return std::any_of(raw.events.begin(), raw.events.end(), [](const VoiceEvent& event) {
    return event.kind == EventKind::phoneme && !event.ipa.empty() && event.ipa[0] != '_' &&
           event.ipa[0] != '(';
  });
}

bool changes(const RawSpeech& raw, int rate, const text::Utterance& utterance) {
  const auto languages = find_languages(raw, rate, utterance);
  return std::any_of(languages.begin(), languages.end(),
                     [](const SpokenLanguage& part) { return part.by_itself; });
}

}  // namespace

Result<LetterCounts> count_letters(const VoiceOptions& options) {
  const auto speakers = find_speakers(options, {});
  if (!speakers) return speakers.error();
  const std::string& language = speakers->list.front().language;
  const std::vector<std::u32string> letters = text::letters_of_language(language);
  const std::u32string carrier = carrier_of(letters);
  const std::size_t step = (letters.size() + kMostLetters - 1) / kMostLetters;
  LetterCounts counts;
  EspeakJob job;
  job.options = options;
  job.voice = speakers->list.front().voice;
  std::vector<text::Utterance> utterances;
  for (std::size_t i = 0; i < letters.size(); i += std::max<std::size_t>(step, 1)) {
    const bool letter = text::is_letter(letters[i].front());
    const bool mark = text::kind_of(letters[i].front()) == text::Kind::mark;
    if (!letter && !mark) continue;  // joiners and apostrophes
    ++counts.letters;
    const std::string written = text::utf8(letters[i]);
    auto utterance = text::make_utterance(text::utf8(mark ? carrier : std::u32string()) + written,
                                          *speakers, helpers_of(options));
    if (!utterance || utterance->markup || utterance->input.size() == 0) {
      counts.foreign.push_back(written);
      continue;
    }
    job.texts.push_back(text::utf8(utterance->input.text));
    utterances.push_back(*std::move(utterance));
  }
  const auto spoken = run_voice(job);
  if (!spoken) return spoken.error();
  for (std::size_t i = 0; i < utterances.size(); ++i) {
    const RawSpeech& raw = spoken->speech[i];
    if (says_something(raw) && !changes(raw, spoken->sample_rate, utterances[i])) {
      ++counts.spoken;
    } else {
      counts.foreign.push_back(text::utf8(utterances[i].source));
    }
  }
  return counts;
}

}  // namespace animeme::voice
