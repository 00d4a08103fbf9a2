// Curves in JSON that each have values of their own, and names of clocks. Internal.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "tools/formats/common/json.h"

namespace animeme::exchange {

/// What a member of that name counts.
enum class ClockUnit : std::uint8_t { none, seconds, milliseconds, frames };

/// By its name: time, timestamp, t ...; timestamp_ms ...; frame, index ...; whatever case and
/// marks.
ClockUnit clock_unit(std::string_view name);

/// Curves that were sampled at the times of all of them.
struct SeriesFrames {
  bool seconds = false;                       ///< else `at` counts frames
  std::vector<double> at;                     ///< ascending
  std::vector<std::map<int, double>> values;  ///< by channel, of each time; NaN: missing
};

/// Curves by name: {"jawOpen": curve} or [{"name": "jawOpen", "values": curve}], at any depth to
/// three, at least two of them. A curve is a list of numbers; of pairs of a time and a number; of
/// objects with both; an object of numbers by number (data frames); or an object with such a curve
/// in it. Between the times of one curve, it is interpolated. nullopt: there are none.
std::optional<SeriesFrames> find_json_series(const tools::Json& root);

}  // namespace animeme::exchange
