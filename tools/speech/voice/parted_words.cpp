#include "tools/speech/voice/parted_words.h"

#include <utility>

#include "tools/speech/text/word_readings.h"
#include "tools/speech/voice/transcript.h"

namespace animeme::voice {

Result<std::vector<text::Token>> parted_words(std::string_view text, const std::string& language) {
  std::vector<text::Token> words;
  if (text::has_unparted_words(language)) {
    auto readings = text::word_readings(text, language);
    if (!readings) return readings.error();
    for (text::WordReading& word : *readings) words.push_back({std::move(word.text), {}, 0});
    return words;
  }
  for (text::Token& token : text::tokens_with_readings(text, language)) {
    if (!token.readings.empty()) {
      words.push_back(std::move(token));
      continue;
    }
    for (std::string& word : split_words(token.text)) words.push_back({std::move(word), {}, 0});
  }
  return words;
}

}  // namespace animeme::voice
