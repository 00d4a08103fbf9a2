/// @file
/// Retargeting by poses: a few poses of one face and the same poses of another tell, control by
/// control, how values of the first become values of the second:
///
///     value of the second = gain * value of the first + offset
///
/// For two faces with the same controls whose ranges differ; faces with other controls need their
/// shapes (dam/crossmap).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dam/signal/signal.h"
#include "fap/result.h"

namespace animeme::dam {

/// Poses of a face: a row of values of its controls for each.
struct Poses {
  std::vector<std::string> names;   ///< of the controls, each once
  std::vector<std::string> labels;  ///< of the poses, each once: "rest", "AA", "smile"
  std::vector<double> values;       ///< labels x names; NaN: the pose says nothing of the control

  /// No check of the indices.
  double at(std::size_t pose, std::size_t control) const {
    return values[pose * names.size() + control];
  }
};

/// True for "rest", "neutral" and "sil" in any case: the pose that offsets are taken from.
bool is_rest_pose(std::string_view label);

/// Where a gain is from.
enum class GainSource : std::uint8_t {
  poses,   ///< fitted to them
  others,  ///< the poses do not move the control: the median gain of those that they do
  none,    ///< no pose of the second face has the control: as it was
};

/// How a control of the first face becomes that of the second.
struct GainOffset {
  double gain = 1;                       ///< below 0: it goes the other way
  double offset = 0;                     ///< in units of the second face
  GainSource source = GainSource::none;  ///< where they are from
  std::size_t poses = 0;                 ///< that both faces have
  double residual = 0;                   ///< root mean square of what the poses are missed by
};

/// One entry a control of `from`, in its order. Poses go together by label (in any case, all words
/// for rest alike), controls by name; those of `to` that `from` does not have are left out. With a
/// resting pose the offset is exactly what rest asks for, and the gain is fitted to the
/// differences from rest by least squares; else both are fitted. `typical`, one value a control or
/// none, is how far controls of the first face usually move (their standard deviation): what the
/// poses move by less than half of it tells no gain. Without it that is a thousandth of the largest
/// value of the control in either face. Offsets below a millionth of that value are 0.
/// Errors: invalid_argument (sizes, names or labels twice, values beyond 1e100), not_found (no
/// control or no pose in common; no pose moves any control).
Result<std::vector<GainOffset>> fit_gain_offset(const Poses& from, const Poses& to,
                                                std::span<const double> typical = {});

/// Applies it to a signal with as many channels.
void apply_gain_offset(Signal& signal, std::span<const GainOffset> gains);

}  // namespace animeme::dam
