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

/// The time of a row: whole and broken seconds, and timecode frames if it is a timecode.
struct RowTime {
  double seconds = 0;
  std::optional<double> frames;  ///< 0 <= frames < timecode frames a second
  std::size_t line = 0;          ///< of the file, for errors
};

/// "hh:mm:ss:ff", "hh:mm:ss:ff.fff", "hh:mm:ss.mmm" or seconds; nothing if it is none of these.
std::optional<RowTime> parse_time(std::string_view field, std::size_t line);

/// Where the rows of a table stand in the clip.
struct PlacedRows {
  fap::Rate rate;
  double unit = 1;  ///< seconds that times count; 0.001 if they were milliseconds
  /// Frame number of each row; nothing: the next row falls on the same frame and counts instead.
  std::vector<std::optional<std::int64_t>> numbers;
};

/// Places rows by their times; the rate, if it is not given, is told from them: see arkit.h.
/// Times whose steps make sense as milli-, micro- or nanoseconds only (more than 3 "seconds" apart,
/// four times at least) are taken so. Timecodes that pass midnight go on. Says in `warnings` how
/// many rows were left out, and what was assumed. `times` is not empty. Errors: out_of_range (times
/// that go back or span more than 10 million frames); invalid_argument (a rate that is not valid;
/// without one, a single time, equal times, or steps beyond 1/16 to 255 frames a second).
Result<PlacedRows> place_rows(const std::vector<RowTime>& times, std::optional<fap::Rate> rate,
                              std::vector<std::string>& warnings);

}  // namespace animeme::exchange
