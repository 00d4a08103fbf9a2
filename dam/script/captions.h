/// @file
/// Captions: the words of a script as people read them, in lines of a limited width, cut at the end
/// of a sentence, at punctuation or at a pause.
///
///     for (const Caption& caption : captions_of(script))
///       show(caption.start, caption.end, caption_text(caption));
///
/// The limits are those of common style guides for subtitles (42 columns, two lines, 1 to 7 s).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "dam/script/words.h"

namespace animeme::dam {

/// Limits of a caption. A single word that exceeds one of them is shown nevertheless.
struct CaptionLimits {
  std::size_t columns = 42;  ///< longest line; a Chinese or Japanese character takes two columns
  std::size_t lines = 2;     ///< at most: 1 or 2
  double shortest = 1;       ///< seconds, as far as the captions before and after leave the time
  double longest = 7;        ///< seconds
};

/// Words that are shown together.
struct Caption {
  double start = 0;  ///< seconds: start of the first word, or a little earlier to be long enough
  double end = 0;    ///< seconds: end of the last word or later, at most the start of the next
  std::vector<std::vector<ScriptWord>> lines;  ///< at least one line, each with at least one word
};

/// The captions of a script: every word once, in order, with its time. Where no word is known, the
/// labels of the phones are shown. Deterministic; time is linear in the number of words.
std::vector<Caption> captions_of(const Script& script, const CaptionLimits& limits = {});

/// The same of words that are known without phones, ascending; `end`: seconds, how long the last
/// caption may be seen.
std::vector<Caption> captions_of(const std::vector<ScriptWord>& words, double end,
                                 const CaptionLimits& limits = {});

/// The words of a line with blanks between them (none between Chinese, Japanese or Thai words).
std::string caption_line(const std::vector<ScriptWord>& line);

/// The lines with a line end between them, without one at the end.
std::string caption_text(const Caption& caption);

/// The same in WebVTT: with the time of each word in front of it, and of its end behind it where
/// the next word does not begin there.
std::string caption_webvtt(const Caption& caption);

/// Whether a blank is written between two words: not between those of scripts that have none.
bool blank_between(std::string_view before, std::string_view after);

}  // namespace animeme::dam
