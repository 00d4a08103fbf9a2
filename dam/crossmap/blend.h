/// @file
/// Fits every frame of a recording by a mixture of key shapes. Source: the paper, Appendix A:
///
///     min | L^i - sum_k alpha_k^i L_k |^2,  alpha_k^i >= 0      for each frame i
///
/// L are displacements from the neutral shape here, not positions. The paper leaves that open; with
/// positions the sum of the coefficients is about 1 without a constraint, but the result depends on
/// the origin, and the neutral shape has to be a key shape. With displacements it is the mixture
/// whose coefficients are all 0.
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
  std::vector<std::string> names;  ///< one per shape
  std::vector<double> values;      ///< shapes x numbers of a shape; all finite
};

/// Two points that meet, such as the middles of the inner lips.
using Contact = std::pair<std::size_t, std::size_t>;

/// Options of fit_blend().
struct BlendOptions {
  std::vector<double> weights;    ///< of points, >= 0; empty: all 1
  std::vector<Contact> contacts;  ///< pairs of points whose distance is fitted in addition
  double contact_weight = 3;      ///< of each coordinate of such a distance, >= 0
  /// Limits the sum of the coefficients of a frame to 1, so that nothing exceeds the key shapes.
  /// False: the only constraint is >= 0, as in the paper.
  bool convex = false;
  double ridge = 1e-4;  ///< see LeastSquaresLimits::ridge, 0..1
  /// Standard deviation in seconds of the Gaussian smoothing of the coefficients over time,
  /// symmetric, so without delay; 0..1. 0: no smoothing. It removes short closures.
  double smooth = 0;
};

/// Points with a residual of their own.
struct Region {
  std::string name;                 ///< for people
  std::vector<std::size_t> points;  ///< indices
};

/// A recording as mixtures.
struct Blend {
  std::vector<double> weights;    ///< alpha: frames x shapes
  std::vector<bool> measured;     ///< per frame; false: no point was seen, see fit_blend()
  std::vector<double> residuals;  ///< frames x regions: root mean square distance of their visible
                                  ///< points from the mixture, units of the points; NaN: none of
                                  ///< them is visible
  std::size_t partly = 0;         ///< frames in which a point with weight was not seen
  std::size_t unseen = 0;         ///< frames in which none was seen
  double residual = 0;            ///< root mean square over all frames and points with weight
};

/// Fits the frames of `track`, displacements. A frame with missing points is fitted to the others;
/// the coefficients of a frame without any are interpolated linearly between its neighbours (at the
/// ends, those of the nearest). The residuals are those after smoothing. Deterministic; except for
/// the last digits and for smoothing, frames are independent. Errors: those of check_tracks();
/// invalid_argument (no key shape, shapes of another size or that are not finite, options, invalid
/// indices of points), not_found (no frame has a point).
Result<Blend> fit_blend(const PointTrack& track, const KeyShapes& keys,
                        std::span<const Region> regions = {}, const BlendOptions& options = {});

/// The shape of a frame of a blend: sum_k alpha_k L_k. The index is not checked.
std::vector<double> blended(const Blend& blend, const KeyShapes& keys, std::size_t frame);

}  // namespace animeme::dam
