// From the shapes of a known speaker to the controls of a corpus: one linear map for all sentences,
// and how well sentences follow their scripts through it. Internal.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dam/training/reference_motion_internal.h"

namespace animeme::dam {

/// The lags that are tried, in seconds.
inline constexpr std::size_t kLags = 51;
inline constexpr double kLagStep = 0.02;
inline double lag_of(std::size_t l) { return (double(l) - double(kLags / 2)) * kLagStep; }

/// A script, and the motion that is held against it: both of one sentence, or of two.
struct Match {
  const SentenceTrack* script;
  const SentenceTrack* motion;
};

/// Least squares, sentence means apart, the motion `lag` seconds after the scripts.
struct ShapeMap {
  std::vector<double> gain;       ///< shapes x controls
  std::vector<double> explained;  ///< share of each control, 0..1
  double fit = 0;                 ///< share of all controls that move, together
};
ShapeMap fit_map(std::span<const Match> matches, double lag);

/// A stretch of speech against its script, through a map, controls weighted by what the map
/// explains of them.
struct LagSums {
  std::vector<double> both,
      asked;          ///< per lag: products of motion and script, squares of the script
  double motion = 0;  ///< squares of the motion
};
/// The sentence in `pieces` equal parts.
std::vector<LagSums> match_at_lags(const Match& match, const ShapeMap& map, std::size_t pieces);
/// The correlation of the whole at one lag.
double match_at(const Match& match, const ShapeMap& map, double lag);

/// Correlations at all lags, of all pieces together.
std::vector<double> correlations(std::span<const LagSums* const> pieces);

/// The highest correlation, its lag by a parabola.
struct LagPeak {
  double lag = 0;
  double correlation = 0;
};
LagPeak peak_of(const std::vector<double>& correlations);

}  // namespace animeme::dam
