/// @file
/// Who spoke which part of a text, and what was not spoken as it should be. Internal.
#pragma once

#include <string>
#include <vector>

#include "dam/script/script.h"
#include "tools/speech/text/utterance.h"
#include "tools/speech/voice/espeak_process.h"

namespace animeme::voice {

/// The languages of `raw` in order, told by the words of `utterance` and by what the voice itself
/// says of its changes ("(en)"). They cover the sound from its first word to its end.
std::vector<SpokenLanguage> find_languages(const RawSpeech& raw, int sample_rate,
                                           const text::Utterance& utterance);

/// The marks of the document.
std::vector<SpeechMark> find_marks(const RawSpeech& raw, int sample_rate,
                                   const text::Utterance& utterance);

/// Words that were not read: letters of another script than Latin that a voice took to another
/// language, and words that it spelled because of a letter that it does not know. A sentence for
/// all of them; empty if there are none.
std::string warn_of_letters(const RawSpeech& raw, const text::Utterance& utterance,
                            const std::vector<SpokenLanguage>& languages);

/// Speech with hardly any vowels, as of a language whose writing leaves them out and whose voice
/// does not know them (Hebrew without points): a sentence about it; empty if there are enough, or
/// too few phones to tell. An R between consonants counts as a vowel, which it is in "krk".
std::string warn_of_missing_vowels(const dam::Script& script, const std::string& voice);

/// A vowel that is written as a sign at a letter, with the first letter that has it in a text, and
/// how often the text has it.
struct VowelSign {
  std::string syllable;   ///< UTF-8: the letter and the sign
  std::string sign;       ///< the sign alone
  std::size_t count = 0;  ///< in the text
};

/// All of them that a text has, the most frequent first, 24 at most.
std::vector<VowelSign> vowel_signs(std::u32string_view text);

/// Vowel signs that a voice speaks without a vowel, as espeak-ng's Thai voice does: a sentence
/// about them if they are more than a twentieth of those in the text; empty if not. `phones` are
/// those of each syllable.
std::string warn_of_vowel_signs(const std::vector<VowelSign>& signs,
                                const std::vector<std::vector<std::string>>& phones,
                                const std::string& voice);

/// Of events in several voices: the IPA that each of them means (espeak_ipa.h).
void correct_ipa(RawSpeech& raw, const text::Utterance& utterance);

}  // namespace animeme::voice
