/// @file
/// Selects the key shapes of a recording: frames that represent the others. Source: the paper,
/// Appendix A, by affinity propagation (Frey and Dueck, Science 315, 2007), its [40].
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "dam/crossmap/points.h"

namespace animeme::dam {

/// Options of find_key_frames().
struct KeyShapeOptions {
  /// Requested number, 1..200: bisection finds the preference, and the nearest number found is
  /// used. 0: as many as `preference` gives.
  std::size_t count = 0;
  /// Preference of a frame to be a key shape, a negative squared distance; larger: more of them.
  /// nullopt: the median of the similarities, as in Frey and Dueck.
  std::optional<double> preference;
  double damping = 0.9;  ///< of the messages, 0.5..0.99
  /// Memory and time grow quadratically with the compared frames (500: 6 MB and less than a second,
  /// all recordings together), 2..4000. If there are more, every n-th is used, n the least whole
  /// number that leaves so many.
  std::size_t most_frames = 500;
};

/// A frame that is a key shape.
struct KeyFrame {
  std::size_t track = 0;  ///< index of the recording
  std::size_t frame = 0;  ///< of that recording
  double share = 0;       ///< of the compared frames, those that are most similar to it; 0..1
};

/// Result of find_key_frames().
struct KeyFrames {
  std::vector<KeyFrame> keys;  ///< by track and frame, at least one
  std::size_t compared = 0;    ///< number of compared frames
  double preference = 0;       ///< that gave them
  bool converged = true;       ///< false: the messages did not converge
};

/// Finds key shapes of recordings of the same points, together. The similarity of two frames is
/// minus the sum of the squared distances of their points, each times the square of its weight
/// (`weights`: one per point; empty: all 1). Frames in which a point with weight is not seen are
/// skipped. Deterministic. Errors: those of check_tracks(); invalid_argument (options; weights that
/// are negative, all 0, or not one per point), not_found (no frame with all points seen).
Result<KeyFrames> find_key_frames(std::span<const PointTrack> tracks,
                                  std::span<const double> weights = {},
                                  const KeyShapeOptions& options = {});

}  // namespace animeme::dam
