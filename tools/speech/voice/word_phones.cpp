#include "tools/speech/voice/word_phones.h"

#include <map>

#include "tools/speech/voice/pronunciation.h"
#include "tools/speech/voice/transcript.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {
namespace {

using Known = std::map<std::string, Labels>;

Result<Known> pronounce_all(const dam::Timings& timings, const AlignOptions& options,
                            std::vector<std::string>& warnings) {
  std::map<std::string, bool> seen;
  std::vector<std::string> words;
  for (const dam::TimedLabel& label : timings.labels) {
    if (!label.is_word) continue;
    for (std::string& word : split_words(label.label)) {
      if (seen.emplace(word, true).second) words.push_back(std::move(word));
    }
  }
  Known known;
  if (words.empty()) return known;
  const auto spoken = find_pronunciations(words, options, warnings);
  if (spoken) {
    for (const SpokenWord& word : *spoken) {
      if (!word.variants.empty()) known[word.text] = word.variants[0];
    }
    return known;
  }
  if (spoken.error().code != Code::not_found) return spoken.error();
  // Without the dictionary of the recogniser a voice knows the words of English, too.
  VoiceOptions voice;
  voice.language = options.language;
  auto guessed = pronounce(words, voice);
  if (!guessed) return spoken.error();
  for (std::size_t i = 0; i < words.size(); ++i) {
    if ((*guessed)[i].empty()) {
      warnings.push_back("no pronunciation for \"" + words[i] + "\"; the word is left out");
    } else {
      known[words[i]] = std::move((*guessed)[i]);
    }
  }
  return known;
}

// The words of a label share its time by the usual lengths of their phones.
void add_phones(const dam::TimedLabel& label, const Known& known, dam::Timings& out) {
  std::vector<std::pair<std::string, const Labels*>> words;
  double total = 0;
  for (const std::string& word : split_words(label.label)) {
    const auto found = known.find(word);
    if (found == known.end()) continue;
    words.emplace_back(word, &found->second);
    for (const std::string& phone : found->second) total += dam::usual_duration(phone);
  }
  double done = 0;
  dam::TimedLabel part = label;
  for (const auto& [word, phones] : words) {
    for (const std::string& phone : *phones) done += dam::usual_duration(phone);
    const bool last = &word == &words.back().first;
    part.end = last ? label.end : label.start + (label.end - label.start) * (done / total);
    part.label = word;
    dam::spread_phones(part, *phones, out.labels);
    part.start = part.end;
  }
}

}  // namespace

Result<dam::Timings> words_to_phones(const dam::Timings& timings, const AlignOptions& options,
                                     std::vector<std::string>& warnings) {
  const auto known = pronounce_all(timings, options, warnings);
  if (!known) return known.error();
  dam::Timings out{timings.format, timings.alphabet, {}};
  for (const dam::TimedLabel& label : timings.labels) {
    if (!label.is_word) {
      out.labels.push_back(label);
      continue;
    }
    if (split_words(label.label).empty()) continue;  // punctuation
    if (!(label.end > label.start)) {
      return error_at_line(Code::syntax,
                           "the word \"" + label.label.substr(0, 40) +
                               "\" does not end after its start; give it a duration or remove it",
                           label.line, label.column);
    }
    add_phones(label, *known, out);
  }
  return out;
}

}  // namespace animeme::voice
