/// @file
/// Which frames of a recording are its key shapes: those that the others look like. Source: the
/// paper, Appendix A, by affinity propagation (Frey and Dueck, Science 315, 2007), its [40].
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dam/crossmap/points.h"

namespace animeme::dam {

/// How key shapes are looked for.
struct KeyShapeOptions {
  /// How many are wanted, 1..200: the preference that gives them is looked for by halving an
  /// interval, and the nearest number found counts. 0: as many as `preference` gives.
  std::size_t count = 0;
  /// How willing a frame is to be a key shape, minus a squared distance; larger: more of them.
  /// Nothing: the median of the similarities, as Frey and Dueck say.
  std::optional<double> preference;
  double damping = 0.9;  ///< of the messages, 0.5..0.99
  /// Memory and time grow with the square of the frames that are compared (500: 6 MB and less than
  /// a second, of all recordings together), 2..4000. Of more, every n-th is taken, n the least
  /// whole number that leaves so many.
  std::size_t most_frames = 500;
};

/// A frame that is a key shape.
struct KeyFrame {
  std::size_t track = 0;  ///< index of the recording
  std::size_t frame = 0;  ///< of that recording
  double share = 0;       ///< of the frames that were compared: those that look most like it; 0..1
};

/// What was found.
struct KeyFrames {
  std::vector<KeyFrame> keys;  ///< by track and frame, one at least
  std::size_t compared = 0;    ///< frames that were compared
  double preference = 0;       ///< that gave them
  bool converged = true;       ///< false: the messages had not come to rest
};

/// Finds key shapes of recordings of the same points, together. The similarity of two frames is
/// minus the sum of the squared distances of their points, each times the square of its weight
/// (`weights`: one a point; empty: all 1). Frames in which a point that counts is not seen are left
/// out. Deterministic.
/// Errors: those of check_tracks(); invalid_argument (options; weights that are not one a point,
/// negative or all 0), not_found (no frame with all points seen).
Result<KeyFrames> find_key_frames(std::span<const PointTrack> tracks,
                                  std::span<const double> weights = {},
                                  const KeyShapeOptions& options = {});

}  // namespace animeme::dam
