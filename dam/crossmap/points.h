/// @file
/// Captured points: markers of a motion capture, landmarks of a video, coils of an articulograph.
///
///     const auto rest = resting_shape(tracks);
///     for (PointTrack& track : tracks) subtract(track, *rest);  // displacement of each point
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::dam {

/// Positions of points, frame by frame, in any unit and any axes, the same for all points.
struct PointTrack {
  std::string name;                ///< of the recording, for people
  fap::Rate rate;                  ///< frames per second
  std::size_t dimensions = 3;      ///< 2 or 3: x, y (and z)
  std::vector<std::string> names;  ///< of the points
  std::vector<double> values;      ///< frames x names x dimensions; NaN: not seen

  std::size_t size() const { return names.size() * dimensions; }  ///< numbers per frame
  /// Number of frames.
  std::size_t frames() const { return size() == 0 ? 0 : values.size() / size(); }
  /// The numbers of a frame: x, y (and z) of the first point, of the second ... Not checked.
  std::span<const double> frame(std::size_t i) const { return {&values[i * size()], size()}; }
  std::span<double> frame(std::size_t i) { return {&values[i * size()], size()}; }  ///< likewise
  /// Whether a point is seen in a frame. The indices are not checked.
  bool seen(std::size_t i, std::size_t point) const {
    for (std::size_t k = 0; k < dimensions; ++k) {
      if (!std::isfinite(values[i * size() + point * dimensions + k])) return false;
    }
    return true;
  }
};

/// Checks that all tracks have the same points in the same order, with values for whole frames.
/// Errors: invalid_argument, with the name of the track (no tracks or frames, dimensions other than
/// 2 or 3, values that do not fill frames, other points or dimensions than the first one, an
/// invalid rate).
Result<void> check_tracks(std::span<const PointTrack> tracks);

/// Keeps these points, by their indices, in this order.
PointTrack with_points(const PointTrack& track, std::span<const std::size_t> points);

/// Medians over frames first..last (inclusive) of a track; NaN for points not seen there.
std::vector<double> median_shape(const PointTrack& track, std::size_t first, std::size_t last);

/// The mouth at rest: median over the stillest `seconds` of all recordings, where the points move
/// least between frames (sum of their squared steps; all of them seen). A recording of speech that
/// begins or ends in silence rests there; for one without any rest, pass the neutral shape instead.
/// Errors: those of check_tracks(); not_found (points are never all seen for so long).
Result<std::vector<double>> resting_shape(std::span<const PointTrack> tracks, double seconds = 0.2);

/// Rotates and translates every frame so that `head`, points that do not move with the face, match
/// their position in `neutral` (least squares; no scaling in 3D, but in an image, where a head that
/// comes nearer grows). A frame with fewer than three of them (two in an image), or with all of
/// them on one line (in one place), has no head pose, and its points become unseen. Returns the
/// number of such frames. Errors: invalid_argument (fewer than three points, two in an image; an
/// invalid index; a point that is not seen in the neutral shape).
Result<std::size_t> hold_head_still(PointTrack& track, std::span<const std::size_t> head,
                                    std::span<const double> neutral);

/// Positions to displacements: subtracts `neutral`, track.size() numbers, from every frame.
void subtract(PointTrack& track, std::span<const double> neutral);

}  // namespace animeme::dam
