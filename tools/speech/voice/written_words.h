/// @file
/// The words of a text as they are written, and when a voice says them. Internal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/speech/text/utterance.h"
#include "tools/speech/voice/espeak_process.h"

namespace animeme::voice {

/// No word.
inline constexpr std::size_t kNoWritten = ~std::size_t(0);

/// The words of an utterance.
struct WrittenWords {
  /// Words with their punctuation, in the order of the text; together, with blanks between them,
  /// they are the text. An entry has several words if the voice announces the first of them only:
  /// "would have". Amounts that are said in another order are one word: "12,50 EUR".
  std::vector<std::vector<std::string>> words;
  /// For each of RawSpeech::events: the entry that is said from this event on; kNoWritten: none.
  std::vector<std::size_t> of_event;
};

/// A word is what blanks separate. In scripts without blanks, a word begins where the voice
/// announces one. Signs that are not spoken belong to the word before them.
WrittenWords written_words(const RawSpeech& raw, const text::Utterance& utterance);

}  // namespace animeme::voice
