/// @file
/// What tables of curves from other programs have in common: names, separators, times of rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/rate.h"
#include "fap/result.h"
#include "tools/commands/arkit_times.h"

namespace animeme::tools {

std::string lower_case(std::string_view text);  ///< of ASCII letters

/// Of comma, semicolon and tab the one that a header line has most of.
char separator_of(std::string_view header);

/// True for timecode, time_s, time and timestamp (lower case): a column of times.
bool is_time_name(std::string_view name);

/// "A, B, C, D, E, F and 3 more".
std::string list_of_names(const std::vector<std::string>& names);

/// Where the rows of a table stand in the clip.
struct PlacedRows {
  fap::Rate rate;  ///< frames a second of the clip
  /// Frame number of each row; nothing: the next row falls on the same frame and counts instead.
  std::vector<std::optional<std::int64_t>> numbers;
};

/// Places rows by their times (see tell_timing() and next_number()); `lines` are their numbers in
/// the file, for errors. Says in `warnings` how many rows were left out. `times` is not empty.
/// Errors: out_of_range (times that go back or span more than 10 million frames), and those of
/// tell_timing().
Result<PlacedRows> place_rows(const std::vector<TimeField>& times,
                              const std::vector<std::size_t>& lines, std::optional<fap::Rate> rate,
                              std::vector<std::string>& warnings);

}  // namespace animeme::tools
