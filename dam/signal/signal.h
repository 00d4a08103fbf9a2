/// @file
/// A control signal: named channels sampled at a constant rate, such as FAPs, ARKit coefficients or
/// a rig's own channels.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fap/rate.h"

namespace animeme::dam {

/// frames x names.size() values, row by row: all channels of frame 0, then of frame 1 ...
/// Frame i is the sample at (first_frame + i) / rate seconds.
struct Signal {
  fap::Rate rate;                  ///< rows per second
  std::size_t first_frame = 0;     ///< number of the first row; not 0 in parts of a stream
  std::vector<std::string> names;  ///< FAP channels are called "fapN_name", e.g. "fap3_open_jaw"
  std::vector<double> values;      ///< frames x names
  std::vector<bool>
      measured;  ///< per frame; false: interpolated, not to be scored. Empty: all true

  /// Number of rows.
  std::size_t frames() const { return names.empty() ? 0 : values.size() / names.size(); }
  /// Seconds of a row.
  double time(std::size_t frame) const { return rate.seconds(double(first_frame + frame)); }
  /// The indices are not checked.
  double& at(std::size_t frame, std::size_t channel) {
    return values[frame * names.size() + channel];
  }
  /// The indices are not checked.
  double at(std::size_t frame, std::size_t channel) const {
    return values[frame * names.size() + channel];
  }
};

}  // namespace animeme::dam
