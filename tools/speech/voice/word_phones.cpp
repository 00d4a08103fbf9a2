#include "tools/speech/voice/word_phones.h"

#include <map>

#include "tools/speech/text/word_readings.h"
#include "tools/speech/voice/parted_words.h"
#include "tools/speech/voice/pronunciation.h"
#include "tools/speech/voice/transcript.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {
namespace {

constexpr std::size_t kMostWords = std::size_t(1) << 20;  // bytes; 16 hours of speech

using Known = std::map<std::string, Labels>;

// The words of a label. Chinese and Japanese labels are words already.
Result<std::vector<text::Token>> tokens_of(const std::string& label, const std::string& language) {
  if (!text::has_unparted_words(language)) return parted_words(label, language);
  std::vector<text::Token> tokens;
  for (std::string& word : split_words(label)) tokens.push_back({std::move(word), {}, 0});
  return tokens;
}

Result<Known> pronounce_all(const dam::Timings& timings, const AlignOptions& options,
                            std::vector<std::string>& warnings) {
  std::map<std::string, bool> seen;
  std::vector<text::Token> words;
  for (const dam::TimedLabel& label : timings.labels) {
    if (!label.is_word) continue;
    auto tokens = tokens_of(label.label, options.language);
    if (!tokens) return tokens.error();
    for (text::Token& word : *tokens) {
      if (seen.emplace(word.text, true).second) words.push_back(std::move(word));
    }
  }
  Known known;
  if (words.empty()) return known;
  const auto spoken = find_pronunciations(words, options, warnings);
  if (spoken) {
    for (const SpokenWord& word : *spoken) {
      if (word.variants.empty()) continue;
      Labels& labels = known[word.text] = word.variants[0];
      std::erase(labels, dam::kSilence);
    }
    return known;
  }
  if (spoken.error().code != Code::not_found) return spoken.error();
  // Without the dictionary of the recogniser a voice knows the words of English, too.
  VoiceOptions voice;
  voice.language = options.language;
  std::vector<std::string> texts;
  for (const text::Token& word : words) {
    texts.push_back(word.readings.empty() ? word.text : word.readings.front());
  }
  auto guessed = pronounce(texts, voice);
  if (!guessed) return spoken.error();
  for (std::size_t i = 0; i < words.size(); ++i) {
    if ((*guessed)[i].empty()) {
      warnings.push_back("no pronunciation for \"" + words[i].text + "\"; the word is left out");
    } else {
      known[words[i].text] = std::move((*guessed)[i]);
    }
  }
  return known;
}

// The words of a label share its time by the usual lengths of their phones.
void add_phones(const dam::TimedLabel& label, const std::vector<text::Token>& tokens,
                const Known& known, dam::Timings& out) {
  std::vector<std::pair<std::string, const Labels*>> words;
  double total = 0;
  for (const text::Token& token : tokens) {
    const auto found = known.find(token.text);
    if (found == known.end()) continue;
    words.emplace_back(token.text, &found->second);
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
  std::size_t bytes = 0;
  for (const dam::TimedLabel& label : timings.labels) {
    bytes += label.is_word ? label.label.size() : 0;
    if (bytes > kMostWords) {
      return error_at_line(Code::out_of_range,
                           "more than 1 MB of words whose phones are to be estimated; split the "
                           "script",
                           label.line, label.column);
    }
  }
  const auto known = pronounce_all(timings, options, warnings);
  if (!known) return known.error();
  dam::Timings out{timings.format, timings.alphabet, {}};
  for (const dam::TimedLabel& label : timings.labels) {
    if (!label.is_word) {
      out.labels.push_back(label);
      continue;
    }
    const auto tokens = tokens_of(label.label, options.language);
    if (!tokens) return tokens.error();
    if (tokens->empty()) continue;  // punctuation
    if (!(label.end > label.start)) {
      return error_at_line(Code::syntax,
                           "the word \"" + label.label.substr(0, 40) +
                               "\" does not end after its start; give it a duration or remove it",
                           label.line, label.column);
    }
    add_phones(label, *tokens, *known, out);
  }
  return out;
}

}  // namespace animeme::voice
