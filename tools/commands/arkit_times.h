/// @file
/// Times of a recording: frame rate and frame numbers from what its rows say.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::tools {

/// The time of a row: whole and broken seconds, and timecode frames if it is a timecode.
struct TimeField {
  double seconds = 0;            ///< whole seconds, or all of the time if `frames` is nothing
  std::optional<double> frames;  ///< 0 <= frames < timecode frames a second
};

/// "hh:mm:ss:ff", "hh:mm:ss:ff.fff", "hh:mm:ss.mmm" or seconds; nothing if it is none of these.
std::optional<TimeField> parse_time(std::string_view field);

/// When rows are.
struct Timing {
  fap::Rate rate;                     ///< frames a second of the clip
  std::vector<double> positions;      ///< of each row, in frames after the first
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Rate (see arkit_csv.h) and positions. Timecodes that pass midnight go on. `times` is not empty.
/// Error: invalid_argument if there is one time only and no `rate`, or all times are equal, or
/// the step between them is beyond 1/16 to 255 frames a second.
Result<Timing> tell_timing(const std::vector<TimeField>& times, std::optional<fap::Rate> rate);

/// The frame number of a row at `position` behind a row with number `previous` (-1: none). Rows
/// that are less than 3/4 of a frame off the number that follows take it, so that jitter neither
/// skips nor merges; equal to `previous`: both rows fall on one frame.
std::int64_t next_number(std::int64_t previous, double position);

}  // namespace animeme::tools
