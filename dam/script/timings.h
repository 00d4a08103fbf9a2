/// @file
/// The content of a script file before it becomes a script: labels with their times. A label is a
/// phone, in the notation of the file, or a word without phones.
///
///     auto timings = animeme::dam::read_timings(text);
///     auto script = animeme::dam::make_script(*timings);   // unless has_words(*timings)
///
/// Words become phones by their pronunciation (tools/speech/voice/word_phones.h). This reader
/// handles the text formats; tools/formats/scripts/script_text.h also reads JSON. The content of
/// each format, its units and its silence: dam/script/phoneme_scripts.md, section 1.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"

namespace animeme::dam {

/// One label with its time.
struct TimedLabel {
  double start = 0;         ///< seconds
  double end = 0;           ///< seconds
  std::string label;        ///< as spelled in the file, UTF-8; empty: silence
  std::string word;         ///< of a phone: the word that it belongs to, if known
  std::int64_t line = 0;    ///< in the file, from 1; 0: unknown
  std::int64_t column = 0;  ///< in the line, in bytes from 1; 0: unknown
  bool is_word = false;     ///< a word, or several separated by spaces, instead of a phone
  Alphabet alphabet = Alphabet::automatic;  ///< of a phone; automatic: that of Timings
  std::string speaker;                      ///< who says it; empty: unknown
  WordLink link = WordLink::automatic;      ///< of a phone, as Phone::link

  friend bool operator==(const TimedLabel&, const TimedLabel&) = default;
};

/// The labels of a file, normally ascending. Their times have not been checked yet; marks are empty
/// labels, and words do not overlap.
struct Timings {
  std::string_view format;  ///< name of the format, see text_script_formats(); static storage
  Alphabet alphabet = Alphabet::automatic;  ///< of the labels that are phones
  std::vector<TimedLabel> labels;           ///< in the order of the file; those of words by time
  std::vector<ScriptNote> notes;            ///< what was left out or read otherwise
};

/// A script format.
struct ScriptFormat {
  std::string_view name;   ///< one word, for ScriptOptions::format
  std::string_view title;  ///< the program that writes it, a description
};

/// The formats of read_timings(), each name once.
std::span<const ScriptFormat> text_script_formats();

/// Reads the labels of a text in any encoding listed in script.h. Errors: those of read_script()
/// about the file; not those about phones and their times.
Result<Timings> read_timings(std::string_view text, const ScriptOptions& options = {});

/// Whether a text, in UTF-8, looks like one of these formats, by its first lines.
bool looks_like_script(std::string_view utf8);

/// Whether any label is a word, which make_script() refuses.
bool has_words(const Timings& timings);

/// Labels to phones, gaps to silence. Errors: those of read_script(), with the position of the
/// label; unsupported (words without phones).
Result<Script> make_script(const Timings& timings);

/// Appends the phones of a word to `out`, in sequence inside its time: vowels take 1.4 and
/// diphthongs 1.8 times as long as consonants. `labels` are those of dam/script/phones.h; if empty,
/// nothing is added.
void spread_phones(const TimedLabel& word, std::span<const std::string> labels,
                   std::vector<TimedLabel>& out);

/// Usual relative duration of a phone, 1 for a consonant.
double usual_duration(std::string_view label);

/// Sets the end of labels that only have a start to the start of the next one. The last one, if it
/// is not silence, and a word before an unmarked pause last at most `longest(label)`. Of labels
/// that start at the same time the last counts.
void end_at_next_start(std::vector<TimedLabel>& labels, double longest(const TimedLabel&));

}  // namespace animeme::dam
