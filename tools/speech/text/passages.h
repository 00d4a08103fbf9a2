/// @file
/// Assigns voices to the parts of a text by script, preferring the main language.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/text/spoken_text.h"

namespace animeme::text {

/// Conversion of a text for a voice.
enum class Letters : std::uint8_t { as_written, pinyin, kana };

/// A voice and the scripts that it reads.
struct Speaker {
  std::string language;              ///< of espeak-ng: "en-us", "cmn"
  std::string voice;                 ///< identifier with variant: "gmw/en-US+f3"
  std::string name;                  ///< "English (America)"
  std::vector<std::string> scripts;  ///< ISO 15924; empty: unknown, it gets everything
  /// the required conversion
  Letters letters = Letters::as_written;
  bool latin_by_itself = false;  ///< switches to English for words in Latin letters, and reports it
  bool says_digits = true;       ///< false: numbers must be spelled out
};

/// Fills in the properties of a voice by its language.
Speaker make_speaker(std::string language, std::string voice, std::string name);

/// Finds a voice for a language; nullopt if there is none.
using FindSpeaker = std::function<std::optional<Speaker>(const std::string& language)>;

/// The available voices.
struct Speakers {
  std::vector<Speaker> list;  ///< the first one is the main one
  bool automatic = false;     ///< add further ones by script and words
  bool by_words = true;       ///< false: the main one gets all letters that it reads
  FindSpeaker find;           ///< may be empty
};

/// A part of a text, spoken by one voice.
struct Passage {
  /// text with positions
  SpokenText said;
  std::size_t speaker = 0;  ///< in Speakers::list
};

/// Splits a text. Letters of a script go to the first voice that reads it; characters without a
/// script (digits, punctuation) to that of the surrounding letters, else to the main voice. Latin
/// letters in a text of another script are spoken by the voice itself if espeak-ng switches to
/// English for them, else by a voice of "en", which is added to the list. With `automatic`, voices
/// are added by script: the language whose alphabet has all letters of the text, by its words
/// (guess.h) if there are several, else the most common one. If several voices of the list read
/// Latin letters, sentences go to the voice of their language; with `automatic`, voices are added
/// for them as well.
///
/// The current voice reads the name of a single Greek letter (µ, π).
///
/// Errors: invalid_argument (no voice reads a script; the message has text, script, and a suitable
/// voice).
Result<std::vector<Passage>> part_passages(const SpokenText& said, Speakers& speakers);

/// The language of a tag without country and variant, in lower case: "en" for "en-US+f3".
std::string main_language(std::string_view tag);

/// The language of the first letters of a text; empty if uncertain (guess.h) or without a known
/// voice.
std::string first_language(std::u32string_view text);

/// The language of the environment, "de-DE" for LANG=de_DE.UTF-8; "en" for C and POSIX.
std::string locale_language();

/// The most likely language of letters of one script, given the whole `text` (kana, for example,
/// imply Japanese). Empty: no voice is known.
std::string language_for(std::string_view script, std::u32string_view text);

}  // namespace animeme::text
