// Cues of subtitles and lyrics, whatever file they are from, and the words in them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/timings.h"

namespace animeme::dam {

/// A piece of the text of a cue, and when it begins if that is said.
struct CuePiece {
  std::string text;
  std::optional<double> start;  ///< seconds
  std::int64_t line = 0, column = 0;
  bool underlined = false;
  std::string speaker;
};

using CueLine = std::vector<CuePiece>;

struct Cue {
  double start = 0, end = 0;   ///< seconds
  std::int64_t line = 0;       ///< of its times
  std::vector<CueLine> lines;  ///< of its text
};

/// "01:02:03.456", "02:03,456" in seconds; nothing if it is no such time.
std::optional<double> parse_clock(std::string_view text);

/// Cues in any order to words: those with times of their own, those that are underlined where a
/// file underlines, else the cue. Lines that captions which roll show again are said once.
void add_words_of_cues(std::vector<Cue> cues, const ScriptOptions& options, Timings& timings);

/// "&amp;", "&eacute;", "&#39;" and "&#x27;" as the characters that they are; what is unknown
/// stays.
std::string without_references(std::string_view text);

}  // namespace animeme::dam
