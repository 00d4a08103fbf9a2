/// @file
/// Every frame of a recording as a mixture of key shapes. Source: the paper, Appendix A:
///
///     min | L^i - sum_k alpha_k^i L_k |^2,  alpha_k^i >= 0      for each frame i
///
/// L are displacements from the neutral shape here, not places. The paper leaves that open; with
/// places the sum of the coefficients is about 1 by itself, but the result depends on where the
/// origin is, and the neutral shape has to be a key shape. With displacements it needs none: it is
/// what no coefficient makes.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dam/crossmap/points.h"
#include "fap/result.h"

namespace animeme::dam {

/// Shapes of the same points: displacements from the neutral shape.
struct KeyShapes {
  std::vector<std::string> names;  ///< one a shape
  std::vector<double> values;      ///< shapes x numbers of a shape; all finite
};

/// Two points that meet, such as the middles of the inner lips.
using Contact = std::pair<std::size_t, std::size_t>;

/// How frames are fitted.
struct BlendOptions {
  std::vector<double> weights;    ///< of points, >= 0; empty: all 1
  std::vector<Contact> contacts;  ///< pairs of points whose distance counts beside their places
  double contact_weight = 3;      ///< of each coordinate of such a distance, >= 0
  /// Coefficients of a frame sum up to 1 at most: nothing goes beyond the key shapes. Without it
  /// they are 0 or more and nothing else, as in the paper.
  bool convex = false;
  double ridge = 1e-4;  ///< see LeastSquaresLimits::ridge, 0..1
  /// Standard deviation in seconds of the bell over time that coefficients are averaged with, both
  /// ways, so nothing is late; 0..1. 0: not at all. Short closures get lost in it.
  double smooth = 0;
};

/// Points whose residual is told apart.
struct Region {
  std::string name;                 ///< for people
  std::vector<std::size_t> points;  ///< indices
};

/// A recording as mixtures.
struct Blend {
  std::vector<double> weights;    ///< alpha: frames x shapes
  std::vector<bool> measured;     ///< per frame; false: no point was seen, see fit_blend()
  std::vector<double> residuals;  ///< frames x regions: root mean square distance of their points
                                  ///< that are seen from the mixture, units of the points; NaN:
                                  ///< none of them is seen
  std::size_t partly = 0;         ///< frames in which a point that counts was not seen
  std::size_t unseen = 0;         ///< frames in which none was
  double residual = 0;            ///< root mean square over all frames and points that count
};

/// Fits the frames of `track`, displacements. A frame with points that are not seen is fitted to
/// the others; one without any gets the coefficients between those of the frames beside it, along a
/// straight line (at the ends, those of the nearest). The residuals are those after smoothing.
/// Deterministic; a frame does not depend on others but for the last digits, and smoothing.
/// Errors: those of check_tracks(); invalid_argument (no key shape, shapes of another size or that
/// are not finite, options, indices of points that are none), not_found (no frame has a point).
Result<Blend> fit_blend(const PointTrack& track, const KeyShapes& keys,
                        std::span<const Region> regions = {}, const BlendOptions& options = {});

/// What a frame of a blend looks like: sum_k alpha_k L_k. No check of the index.
std::vector<double> blended(const Blend& blend, const KeyShapes& keys, std::size_t frame);

}  // namespace animeme::dam
