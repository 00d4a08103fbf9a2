/// @file
/// Which voice speaks which part of a text: by its script, main language first.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/text/said.h"

namespace animeme::text {

/// What a text becomes before a voice reads it.
enum class Letters : std::uint8_t { as_written, pinyin, kana };

/// A voice and what it reads.
struct Speaker {
  std::string language;              ///< of espeak-ng: "en-us", "cmn"
  std::string voice;                 ///< identifier with variant: "gmw/en-US+f3"
  std::string name;                  ///< "English (America)"
  std::vector<std::string> scripts;  ///< ISO 15924; empty: nothing is known, all is given to it
  /// what it wants to be given
  Letters letters = Letters::as_written;
  bool latin_by_itself = false;  ///< changes to English for words in Latin letters, and says so
  bool says_digits = true;       ///< false: numbers have to be words
};

/// Fills in what is known of a voice by its language.
Speaker make_speaker(std::string language, std::string voice, std::string name);

/// Finds a voice for a language; nothing if there is none.
using FindSpeaker = std::function<std::optional<Speaker>(const std::string& language)>;

/// Who may speak.
struct Speakers {
  std::vector<Speaker> list;  ///< the first one is the main one
  bool automatic = false;     ///< further ones are found by script and words
  bool by_words = true;       ///< false: the main one has all letters that it reads
  FindSpeaker find;           ///< may be empty
};

/// A part of a text, spoken by one voice.
struct Passage {
  /// what is spoken, with its places
  Said said;
  std::size_t speaker = 0;  ///< in Speakers::list
};

/// Parts a text. Letters of a script go to the first voice that reads it; what has no script
/// (digits, punctuation) to that of the letters around it, else to the main one. Latin letters in a
/// text of another script are spoken by the voice itself where espeak-ng changes to English for
/// them, else by a voice of "en", which is added to the list. With `automatic` voices are added by
/// script: the language whose alphabet has all letters of the text, by its words (guess.h) where
/// several have, else the usual one. Sentences in Latin letters go to the voice of their language
/// where several voices of the list read them; with `automatic` voices are added for them, too.
///
/// A single Greek letter stays with the voice, which says its name (µ, π).
///
/// Errors: invalid_argument, a script that no voice reads: text, script, and the voice to take.
Result<std::vector<Passage>> part_passages(const Said& said, Speakers& speakers);

/// The language of a tag without country and variant, in small letters: "en" of "en-US+f3".
std::string main_language(std::string_view tag);

/// The language of the first letters of a text; empty where it is not sure (guess.h) or no voice
/// is known.
std::string first_language(std::u32string_view text);

/// The language of the environment, "de-DE" for LANG=de_DE.UTF-8; "en" for C and POSIX.
std::string locale_language();

/// The language that most likely is written with these letters of one script; `with_kana` and the
/// like are told by `text`, the whole of it. Empty: no voice can be named.
std::string language_for(std::string_view script, std::u32string_view text);

}  // namespace animeme::text
