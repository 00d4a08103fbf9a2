// Times of a recording: frame rate and frame numbers from what its rows say.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::exchange {

/// The time of a row: whole and broken seconds, and the last field if it is a timecode.
struct RowTime {
  double seconds = 0;
  std::optional<double> frames;  ///< behind hh:mm:ss; see Reading for what it may mean
  std::size_t line = 0;          ///< of the file, for errors
  int digits = 0;                ///< of `frames`, before the point
  bool fraction = false;         ///< `frames` has digits behind a point
  bool drop = false;             ///< hh:mm:ss;ff: labels are left out at the start of minutes
};

/// "hh:mm:ss:ff", "hh:mm:ss;ff", "hh:mm:ss:ff.fff", "hh:mm:ss:mmm", "hh:mm:ss.mmm", "mm:ss.mmm" (or
/// with a comma before mmm), these behind a date ("2026-11-27T", with or without a time zone), or
/// seconds ("1.5", "1.5s", "1500ms"); nothing if it is none of these.
std::optional<RowTime> parse_time(std::string_view field, std::size_t line);

/// Where the rows of a table stand in the clip.
struct PlacedRows {
  fap::Rate rate;
  double unit = 1;  ///< seconds that times count; 0.001 if they were milliseconds
  /// Frame number of each row; nothing: the next row falls on the same frame and counts instead.
  std::vector<std::optional<std::int64_t>> numbers;
  /// Rows in even steps before which a frame number is left out, ascending: no rate that can be
  /// coded is theirs, and the clip would run ahead of them.
  std::vector<std::size_t> late = {};
};

/// Places rows by their times; the rate, if it is not given, is told from them: see arkit.h.
/// What the last field of a timecode means is told by which reading makes the steps even:
/// frames, and fractions of a frame ("00:12.500" is frame 12.5); frames, and milliseconds of the
/// second behind a point ("12.200" is 0.2 s); milliseconds of the second ("200", "200.000"). A
/// field of drop-frame timecodes counts frames of 1001/30000 s (or half of that). Rows in even
/// steps are never dropped, and get consecutive numbers as long as they stay within 40 ms. Times
/// whose steps make sense as milli-, micro- or nanoseconds only (more than 3 "seconds" apart, four
/// times at least) are taken so. Timecodes that pass midnight go on. Says in `warnings` how many
/// rows were left out, and what was assumed. `times` is not empty. Errors: out_of_range (times that
/// go back or span more than 10 million frames); invalid_argument (a rate that is not valid;
/// without one, a single time, equal times, or steps beyond 1/16 to 255 frames a second).
Result<PlacedRows> place_rows(const std::vector<RowTime>& times, std::optional<fap::Rate> rate,
                              std::vector<std::string>& warnings);

}  // namespace animeme::exchange
