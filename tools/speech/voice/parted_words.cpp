#include "tools/speech/voice/parted_words.h"

#include "tools/speech/text/word_readings.h"
#include "tools/speech/voice/transcript.h"

namespace animeme::voice {

Result<std::vector<std::string>> parted_words(std::string_view text, std::string_view language) {
  if (!text::has_unparted_words(language)) return split_words(text);
  const auto readings = text::word_readings(text, language);
  if (!readings) return readings.error();
  std::vector<std::string> words;
  for (const text::WordReading& word : *readings) words.push_back(word.text);
  return words;
}

}  // namespace animeme::voice
