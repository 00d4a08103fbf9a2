// The numbers of training: Eq. 2 as a least squares problem. Not for users of the library, see
// train.h. Source: the paper, sections V-B to V-D; dam/lipsync.md, sections 3 and 4.
//
// Everything is in units of the training standard deviation, measured from rest. Polynomials are
// kept in Legendre polynomials of 2u - 1 here, which spans the same functions as the powers of
// Eq. 3 and lets one ridge fit all degrees; power_coefficients() changes them into a^0 .. a^M.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "dam/corpus/speech_data_internal.h"

namespace animeme::dam {

/// What is fitted.
struct FitData : SpeechData {
  int order = 4;
  double time_margin = 0.5;
  bool normalised = false;  ///< blend by D / sum of D, see AnimemeOptions

  std::size_t terms() const { return std::size_t(order) + 1; }
};

struct FitWeights {
  double ridge = 10;        ///< on the coefficients, in frames
  double width_prior = 10;  ///< on log(sigma), per control
  int threads = 0;
};

/// What is found.
struct FitState {
  std::vector<double> sigma;         ///< per mode
  std::vector<double> coefficients;  ///< modes x terms x controls
  double objective = 0;              ///< squared error + ridge + width prior
};

/// One phone's part in one frame.
struct Part {
  std::uint32_t occurrence = 0;
  std::uint32_t mode = 0;
  double dominance = 0;  ///< D, divided by the sum of all D of the frame if normalised
  double slope = 0;      ///< dD / d log(sigma), divided likewise
  double basis[9] = {};  ///< Legendre polynomials at the local time
};

/// parts[begin[i]] .. parts[begin[i + 1] - 1] belong to frame i of the sentence, by occurrence.
struct Design {
  std::vector<std::size_t> begin;
  std::vector<Part> parts;

  std::span<const Part> frame(std::size_t i) const {
    return {parts.data() + begin[i], begin[i + 1] - begin[i]};
  }
};

/// Frames [begin, end) of a sentence.
struct FrameRange {
  std::size_t begin = 0, end = 0;
};

/// Frames that an occurrence reaches with a width of `sigma`.
FrameRange reach_of(const FitData& data, const FitSentence& sentence, const FitOccurrence& o,
                    double sigma);

/// Legendre polynomials 0 .. order of 2u - 1, u clamped by `margin`.
void legendre(double u, double margin, int order, double* out);

/// Occurrences that have a part in the frames of a sentence.
Design make_design(const FitData& data, const FitSentence& sentence, std::span<const double> sigma);

/// The same before normalisation, whatever the blend.
Design make_raw_design(const FitData& data, const FitSentence& sentence,
                       std::span<const double> sigma);

/// Fitted signal of a sentence: frames x controls.
std::vector<double> predict(const FitData& data, const FitState& state, const FitSentence& sentence,
                            const Design& design);

/// E-step: the best coefficients for fixed widths (Eq. 5 with the ties of Eq. 7) and the objective.
/// `modes` is sigma.size() of `state`.
void solve_coefficients(const FitData& data, const FitWeights& weights, FitState& state);

/// The normal equations of the M-step for log(sigma): Eq. 9 with the coefficients kept fixed
/// (`project` false) or re-fitted to first order (variable projection, Kaufman's form).
struct WidthStep {
  std::vector<double> gradient;  ///< modes; points downhill
  std::vector<double> hessian;   ///< modes x modes
};
WidthStep width_step(const FitData& data, const FitWeights& weights, const FitState& state,
                     bool project);

/// Repeats both steps until the objective falls by less than `tolerance` of itself; every step is
/// accepted only if the objective falls. `accepted` is called after each and returns false to
/// stop. Returns true if it converged.
bool expectation_maximisation(const FitData& data, const FitWeights& weights, int max_iterations,
                              double tolerance, FitState& state,
                              const std::function<bool(const FitState&)>& accepted);

/// Coefficients a^0 .. a^M by powers of u from those by Legendre polynomials.
std::vector<double> power_coefficients(std::span<const double> legendre_coefficients);

}  // namespace animeme::dam
