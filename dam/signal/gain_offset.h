/// @file
/// Retargeting by poses: a few poses of one face and the same poses of another define, control by
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
  std::vector<double> values;       ///< labels x names; NaN: undefined in this pose

  /// The indices are not checked.
  double at(std::size_t pose, std::size_t control) const {
    return values[pose * names.size() + control];
  }
};

/// True for "rest", "neutral" and "sil" in any case: the pose that offsets are taken from.
bool is_rest_pose(std::string_view label);

/// Origin of a gain.
enum class GainSource : std::uint8_t {
  poses,   ///< fitted to the poses
  others,  ///< the poses do not move the control: the median gain of the controls they move
  none,    ///< no pose of the second face has the control: unchanged
};

/// Mapping of a control of the first face to the second.
struct GainOffset {
  double gain = 1;                       ///< below 0: inverted
  double offset = 0;                     ///< in units of the second face
  GainSource source = GainSource::none;  ///< see GainSource
  std::size_t poses = 0;                 ///< number of poses that both faces have
  double residual = 0;                   ///< root mean square error over the poses
};

/// One entry per control of `from`, in its order. Poses are matched by label (in any case, all
/// words for rest alike), controls by name; those of `to` that `from` does not have are ignored.
/// With a resting pose the offset maps rest to rest exactly, and the gain is fitted to the
/// differences from rest by least squares; otherwise both are fitted. `typical`, one value per
/// control or empty, is the usual motion of the first face's controls (their standard deviation):
/// if the poses move a control by less than half of it they do not determine its gain. Without it
/// the threshold is a thousandth of the largest value of the control in either face. Offsets below
/// a millionth of that value are 0. Errors: invalid_argument (sizes, duplicate names or labels,
/// values beyond 1e100), not_found (no control or no pose in common; no pose moves any control).
Result<std::vector<GainOffset>> fit_gain_offset(const Poses& from, const Poses& to,
                                                std::span<const double> typical = {});

/// Applies gains and offsets to a signal with as many channels.
void apply_gain_offset(Signal& signal, std::span<const GainOffset> gains);

}  // namespace animeme::dam
