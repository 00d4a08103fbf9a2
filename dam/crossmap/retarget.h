/// @file
/// Key shapes of a recording to the controls of a character. Source: the paper, Appendix A: the
/// artist's shapes V_k of the target are mixed like the frames of the recording (blend.h), and
/// controls are fitted to the resulting vertices:
///
///     V^i = sum_k alpha_k^i V_k,   min | V^i - sum_c C_c^i B_c |^2,  low_c <= C_c^i <= high_c
///
/// All vertices are displacements from the character's neutral face; B_c is the effect of control c
/// at 1, the paper's transfer function of blend shapes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dam/crossmap/blend.h"
#include "dam/signal/signal.h"
#include "fap/result.h"

namespace animeme::dam {

/// The controls of a character and its key shapes. "Rows" are coordinates of vertices, or anything
/// else that is linear in the controls.
struct Character {
  std::vector<std::string> controls;  ///< names
  std::vector<double> lows;           ///< of each control, usually 0
  std::vector<double> highs;          ///< of each control, usually 1
  std::size_t rows = 0;               ///< of a shape
  std::vector<double> moves;          ///< B: rows x controls, effect of each control at 1
  std::vector<double> keys;           ///< V: key shapes x rows
};

/// Options of fit_controls().
struct RetargetOptions {
  /// See LeastSquaresLimits::ridge. The default keeps similar controls from cancelling each other.
  double ridge = 1e-3;
};

/// Control curves of a recording.
struct Retarget {
  Signal signal;  ///< of the controls; `measured` as in the blend
  std::vector<double>
      residuals;            ///< per frame: root mean square over rows of the error against the
                            ///< mixed vertices, in units of the rows (to 1e-7 of their size)
  std::size_t limited = 0;  ///< frames in which a control is at its upper limit
};

/// Fits the controls to every frame of a blend. Deterministic.
/// Errors: invalid_argument (no control, sizes that do not match, limits that are not numbers or
/// reversed, values that are not finite, a ridge outside 0..1; key shapes other than those of the
/// blend).
Result<Retarget> fit_controls(const Blend& blend, fap::Rate rate, const Character& character,
                              const RetargetOptions& options = {});

/// A character whose key shapes are given as values of its controls, one row per key shape ("if the
/// target has well-defined bases, the coefficients are the control signal"): controls are mixed and
/// clamped to their limits. `values`: key shapes x controls.
/// Errors: as fit_controls().
Result<Retarget> mix_controls(const Blend& blend, fap::Rate rate, const Character& character,
                              const std::vector<double>& values);

}  // namespace animeme::dam
