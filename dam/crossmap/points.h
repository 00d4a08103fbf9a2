/// @file
/// Captured points: markers of a motion capture, landmarks of a video, coils of an articulograph.
///
///     const auto rest = resting_shape(tracks);
///     for (PointTrack& track : tracks) subtract(track, *rest);  // how far each point has moved
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::dam {

/// Places of points, frame by frame, in any unit and any axes, the same for all points.
struct PointTrack {
  std::string name;                ///< of the recording, for people
  fap::Rate rate;                  ///< frames a second
  std::size_t dimensions = 3;      ///< 2 or 3: x, y (and z)
  std::vector<std::string> names;  ///< of the points
  std::vector<double> values;      ///< frames x names x dimensions; NaN: not seen

  std::size_t size() const { return names.size() * dimensions; }  ///< numbers of a frame
  /// Number of frames.
  std::size_t frames() const { return size() == 0 ? 0 : values.size() / size(); }
  /// The numbers of a frame: x, y (and z) of the first point, of the second ... No check.
  std::span<const double> frame(std::size_t i) const { return {&values[i * size()], size()}; }
  std::span<double> frame(std::size_t i) { return {&values[i * size()], size()}; }  ///< likewise
  /// Is a point seen in a frame? No check of the indices.
  bool seen(std::size_t i, std::size_t point) const {
    for (std::size_t k = 0; k < dimensions; ++k) {
      if (!std::isfinite(values[i * size() + point * dimensions + k])) return false;
    }
    return true;
  }
};

/// The same points in the same order in all tracks, with values for whole frames? Errors:
/// invalid_argument, with the name of the track (no tracks or frames, dimensions that are not 2 or
/// 3, values that do not fill frames, other points or dimensions than the first one, a rate that is
/// none).
Result<void> check_tracks(std::span<const PointTrack> tracks);

/// Keeps these points, by their indices, in this order.
PointTrack with_points(const PointTrack& track, std::span<const std::size_t> points);

/// Medians over frames first..last (inclusive) of a track; NaN for points not seen there.
std::vector<double> median_shape(const PointTrack& track, std::size_t first, std::size_t last);

/// Where a mouth rests: median over the stillest `seconds` of all recordings, which is where the
/// points move least from one frame to the next (sum of their squared steps; all of them seen). A
/// recording of speech that begins or ends in silence rests there; one without any rest should be
/// told its neutral shape. Errors: those of check_tracks(); not_found (no such stretch: points
/// are never all seen for so long).
Result<std::vector<double>> resting_shape(std::span<const PointTrack> tracks, double seconds = 0.2);

/// Turns and shifts every frame so that `head`, points that do not move with the face, lie where
/// they lie in `neutral` (least squares; no change of size in space, one in a picture, where a head
/// that comes nearer grows). A frame with fewer than three of them (two in a picture), or with all
/// of them in one line (one place), has no head, and its points are not seen. Returns how many frames that were.
/// Errors: invalid_argument (fewer than three points, two in a picture; an index that is none; a
/// point that is not seen in the neutral shape).
Result<std::size_t> hold_head_still(PointTrack& track, std::span<const std::size_t> head,
                                    std::span<const double> neutral);

/// Places to displacements: every frame less `neutral`, track.size() numbers.
void subtract(PointTrack& track, std::span<const double> neutral);

}  // namespace animeme::dam
