// Inside of read_script(): from the intervals that a file holds to a Script. Internal:
// each reader of a format ends here.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"

namespace animeme::dam {

/// An interval as the file has it.
struct RawPhone {
  double start = 0;
  double end = 0;
  std::string label;
  std::string word;
  std::int64_t line = 0;  ///< for messages
};

/// Maps the labels, checks the times, fills gaps. Errors as read_script().
Result<Script> make_script(const std::vector<RawPhone>& raw, Alphabet alphabet);

/// A time in seconds. Errors: syntax (no number), out_of_range (not finite, too large).
Result<double> parse_seconds(std::string_view field, std::int64_t line, std::string_view what);

/// `text` in quotes, fit to be shown: cut to 40 bytes, control characters replaced.
std::string in_quotes(std::string_view text);

/// Shortest text that reads back as the same number.
std::string format_seconds(double seconds);

/// The readers. `text` is UTF-8.
Result<Script> read_tsv(std::string_view text, const ScriptOptions& options);
Result<Script> read_textgrid(std::string_view text, const ScriptOptions& options);

/// Do they feel responsible for this text?
bool looks_like_tsv(std::string_view text);
bool looks_like_textgrid(std::string_view text);

}  // namespace animeme::dam
