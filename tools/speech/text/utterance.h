/// @file
/// The input for espeak-ng: split by script, normalised by language, with markup, and with
/// positions in the user's text.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/speech/text/mood_marks.h"
#include "tools/speech/text/passages.h"
#include "tools/speech/text/spoken_text.h"

namespace animeme::text {

/// The speaker of a range of Utterance::input.
struct Stretch {
  /// characters, from 0, one behind
  std::size_t first = 0, last = 0;  ///< code points of the input, from 0, one behind
  std::size_t speaker = 0;          ///< in Utterance::speakers
};

/// The input for espeak-ng.
struct Utterance {
  std::u32string source;   ///< the text as written; for SSML without markup
  SpokenText input;        ///< for espeak-ng; markup has empty positions
  bool markup = false;     ///< the input is SSML for espeak-ng
  bool mnemonics = false;  ///< [[ ]] in the input are phonemes
  /// the voices
  std::vector<Speaker> speakers;
  std::vector<Stretch> stretches;  ///< ascending
  std::vector<MoodPlace> moods;    ///< in `source`; the later ones inside of the earlier
  std::vector<std::string> marks;  ///< mark number N of the input is called "N"
  /// Of each mark: seconds from where the voice puts it to where it is, because of the breaks
  /// below.
  std::vector<double> mark_shifts;
  /// Seconds of the breaks in front of all words. The input does not have them: espeak-ng leaves
  /// them out.
  double lead_break = 0;
  double tail_break = 0;              ///< likewise behind all words
  std::vector<std::string> warnings;  ///< sentences for the user
};

/// Callbacks.
struct Helpers {
  /// Finds the voice for a name in the document, a language or a variant, in `language`.
  std::function<std::optional<Speaker>(const std::string& language, const std::string& voice)> find;
  /// Converts IPA to the phoneme names of a voice; empty if nothing of it is a sound. `replaced`
  /// receives what the voice lacks, with what is said for it: "ɝ as ɜː".
  std::function<std::string(const Speaker& speaker, const std::string& ipa,
                            std::vector<std::string>& replaced)>
      mnemonics;
};

/// Makes an utterance from plain text or from an SSML document (detected by is_ssml()). Plain text
/// for one voice that needs no conversion is unchanged.
///
/// Errors: those of part_passages(), read_ssml() and read_japanese(); not_found (an unavailable
/// xml:lang or voice of the document).
Result<Utterance> make_utterance(std::string_view text, Speakers speakers, const Helpers& helpers);

}  // namespace animeme::text
