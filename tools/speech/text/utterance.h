/// @file
/// A text as it is handed to espeak-ng: parted by script, read by language, with its markup, and
/// with the way back to what the user wrote.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/speech/text/passages.h"
#include "tools/speech/text/said.h"

namespace animeme::text {

/// Which characters of Utterance::input are spoken by whom.
struct Stretch {
  /// characters, from 0, one behind
  std::size_t first = 0, last = 0;  ///< code points of the input, from 0, one behind
  std::size_t speaker = 0;          ///< in Utterance::speakers
};

/// What espeak-ng is given.
struct Utterance {
  std::u32string source;   ///< what was written; of SSML its text alone
  Said input;              ///< for espeak-ng; markup stands for empty places
  bool markup = false;     ///< the input is SSML for espeak-ng
  bool mnemonics = false;  ///< [[ ]] in the input are phonemes
  /// who speaks
  std::vector<Speaker> speakers;
  std::vector<Stretch> stretches;     ///< ascending
  std::vector<std::string> marks;     ///< mark number N of the input is called "N"
  std::vector<std::string> warnings;  ///< sentences for people
};

/// Where help from outside is needed.
struct Helpers {
  /// The voice of a name in the document, a language or a variant, for one of `language`.
  std::function<std::optional<Speaker>(const std::string& language, const std::string& voice)> find;
  /// IPA in the phoneme names of a voice; empty if it has none for a letter.
  std::function<std::string(const Speaker& speaker, const std::string& ipa)> mnemonics;
};

/// Makes an utterance of plain text or, told by its content (is_ssml()), of an SSML document.
/// A plain text of one voice that reads it as it stands is handed on unchanged.
///
/// Errors: those of part_passages(), read_ssml() and read_japanese(); not_found (an xml:lang or
/// voice of the document that is not there).
Result<Utterance> make_utterance(std::string_view text, Speakers speakers, const Helpers& helpers);

}  // namespace animeme::text
