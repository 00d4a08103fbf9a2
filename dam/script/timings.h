/// @file
/// What a file says about when something is spoken, before it is a script: labels with their times.
/// A label is a phone, in the letters of the file, or a word whose phones nobody told.
///
///     auto timings = animeme::dam::read_timings(text);
///     auto script = animeme::dam::make_script(*timings);   // unless has_words(*timings)
///
/// Words become phones by their pronunciation, which is not known here:
/// tools/speech/voice/word_phones.h. The formats are those of text;
/// tools/formats/scripts/script_text.h reads JSON, too. What each holds, its units and its silence:
/// dam/script/phoneme_scripts.md, section 1.
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
  std::string label;        ///< as the file spells it, UTF-8; empty: silence
  std::string word;         ///< of a phone: the word that it belongs to, if that is known
  std::int64_t line = 0;    ///< in the file, from 1; 0: not known
  std::int64_t column = 0;  ///< in the line, in bytes from 1; 0: not known
  bool is_word = false;     ///< a word, or several between blanks, instead of a phone
  Alphabet alphabet = Alphabet::automatic;  ///< of a phone; automatic: that of Timings

  friend bool operator==(const TimedLabel&, const TimedLabel&) = default;
};

/// The labels of a file, ascending in a sane one; nothing has been tested yet.
struct Timings {
  std::string_view format;  ///< name of the format, see text_script_formats(); static storage
  Alphabet alphabet = Alphabet::automatic;  ///< of the labels that are phones
  std::vector<TimedLabel> labels;           ///< in the order of the file
};

/// A format as people choose it.
struct ScriptFormat {
  std::string_view name;   ///< one word, for ScriptOptions::format
  std::string_view title;  ///< who writes it, what it is
};

/// The formats that read_timings() reads, each name once.
std::span<const ScriptFormat> text_script_formats();

/// Reads the labels of a text of any encoding that script.h names. Errors: those of read_script()
/// that are about the file; not those about phones and their times.
Result<Timings> read_timings(std::string_view text, const ScriptOptions& options = {});

/// Whether a text, in UTF-8, looks like one of these formats, by its first lines.
bool looks_like_script(std::string_view utf8);

/// Whether a label is a word, so that make_script() refuses.
bool has_words(const Timings& timings);

/// Labels to phones, gaps to silence. Errors: those of read_script(), with the place of the label;
/// unsupported (words without phones).
Result<Script> make_script(const Timings& timings);

/// The phones of a word, one after the other inside its time: vowels take 1.4 and diphthongs 1.8
/// times as long as consonants. `labels` are those of dam/script/phones.h; none: nothing is added.
void spread_phones(const TimedLabel& word, std::span<const std::string> labels,
                   std::vector<TimedLabel>& out);

/// How long a phone usually lasts beside others, 1 for a consonant.
double usual_duration(std::string_view label);

/// Gives labels that only have a start their end: the start of the next. The last one, if it is no
/// silence, and a word before a pause that nothing marks, last as long as `longest(label)` says at
/// most. Of labels that start at the same time the last counts.
void end_at_next_start(std::vector<TimedLabel>& labels, double longest(const TimedLabel&));

}  // namespace animeme::dam
