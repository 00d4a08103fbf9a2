/// @file
/// Key shapes of a recording to the controls of a character. Source: the paper, Appendix A: the
/// artist's shapes V_k of the target are mixed as the frames of the recording are (blend.h), and
/// controls are fitted to the vertices that come of it:
///
///     V^i = sum_k alpha_k^i V_k,   min | V^i - sum_c C_c^i B_c |^2,  low_c <= C_c^i <= high_c
///
/// All vertices are displacements from the character's neutral face; B_c is what control c does to
/// them at 1, which is the paper's transfer function of blend shapes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dam/crossmap/blend.h"
#include "dam/signal/signal.h"
#include "fap/result.h"

namespace animeme::dam {

/// The controls of a character and its key shapes. "Rows" are coordinates of vertices, or anything
/// else that the controls move in proportion.
struct Character {
  std::vector<std::string> controls;  ///< names
  std::vector<double> lows;           ///< of each control, as a rule 0
  std::vector<double> highs;          ///< of each control, as a rule 1
  std::size_t rows = 0;               ///< of a shape
  std::vector<double> moves;          ///< B: rows x controls, what 1 of each control does
  std::vector<double> keys;           ///< V: key shapes x rows
};

/// How controls are fitted.
struct RetargetOptions {
  /// See LeastSquaresLimits::ridge. The default keeps controls that do nearly the same from working
  /// against each other.
  double ridge = 1e-3;
};

/// Control curves of a recording.
struct Retarget {
  Signal signal;                  ///< of the controls; `measured` as in the blend
  std::vector<double> residuals;  ///< per frame: root mean square over rows of what the controls
                                  ///< cannot make of the mixed vertices, in units of the rows (to
                                  ///< 1e-7 of their size)
  std::size_t limited = 0;        ///< frames in which a control stands at its upper limit
};

/// Fits the controls to every frame of a blend. Deterministic.
/// Errors: invalid_argument (no control, sizes that do not fit, limits that are no numbers or the
/// wrong way round, values that are not finite, a ridge outside 0..1; key shapes that are not those
/// of the blend).
Result<Retarget> fit_controls(const Blend& blend, fap::Rate rate, const Character& character,
                              const RetargetOptions& options = {});

/// A character whose key shapes are given as values of its controls, one row a key shape ("if the
/// target has well-defined bases, the coefficients are the control signal"): controls are mixed and
/// held within their limits. `values`: key shapes x controls.
/// Errors: as fit_controls().
Result<Retarget> mix_controls(const Blend& blend, fap::Rate rate, const Character& character,
                              const std::vector<double>& values);

}  // namespace animeme::dam
