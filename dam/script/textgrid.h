/// @file
/// Praat TextGrid files: tiers of labelled intervals and points, text form only.
///
/// Praat writes a long form with names ("xmin = 0.5") and a short one without ("0.5"). One rule
/// covers both: only free-standing numbers, "strings" and `<flags>` count; all other words and
/// everything after an exclamation mark are comments.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/timings.h"
#include "fap/result.h"

namespace animeme::dam {

/// One interval; a point has end == start.
struct TextGridItem {
  double start = 0;         ///< seconds
  double end = 0;           ///< seconds
  std::string text;         ///< UTF-8, with doubled quotes resolved
  std::int64_t line = 0;    ///< of the text in the file, from 1; 0: not from a file
  std::int64_t column = 0;  ///< in the line, from 1; 0: unknown
};

/// One tier: intervals without gaps, or points.
struct TextGridTier {
  std::string name;                 ///< as in the file
  bool points = false;              ///< a TextTier (points in time) instead of an IntervalTier
  std::vector<TextGridItem> items;  ///< ascending
};

/// A whole file.
struct TextGrid {
  double start = 0;                 ///< seconds
  double end = 0;                   ///< seconds
  std::vector<TextGridTier> tiers;  ///< in the order of the file
  std::vector<ScriptNote> notes;    ///< counts of the file that disagree with what it holds
};

/// Reads the text form from UTF-8 (see to_utf8() for other encodings). All tiers and entries that
/// are there are read, whatever number of them the file claims. Order and overlaps of times are not
/// checked. Errors with line: syntax, out_of_range (a number that is not finite), truncated
/// (the text ends early), unsupported (a binary file).
Result<TextGrid> parse_textgrid(std::string_view utf8);

/// The labels of one tier: options.tier (its name in any case, or its number from 1), else that of
/// options.speaker, or the phones with their words, or the words alone, by the names in script.h,
/// or the only one that holds intervals. Points are not labels. Errors: not_found (no such tier,
/// none of these names, several; the message has all names), unsupported (a tier of points).
Result<Timings> labels_of_tier(const TextGrid& grid, const ScriptOptions& options = {});

/// The tiers "words" and "phones" of a script; silence has an empty text.
TextGrid textgrid_of(const Script& script);

/// The long form, in UTF-8.
std::string format_textgrid(const TextGrid& grid);

}  // namespace animeme::dam
