// From sums to the parameters of a model: what is the same whether the sums were taken in one go or
// in parts. Internal.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "dam/corpus/train_options.h"
#include "dam/kinds/refined/curves_fit.h"
#include "dam/maths/ridge_solver.h"
#include "dam/model/model.h"

namespace animeme::dam {

/// One sentence of so many is held out to choose the ridge, if there are twice as many at least.
inline constexpr std::size_t kHeldOut = 8;
inline constexpr std::size_t kLeastToChoose = 2 * kHeldOut;
/// The factor where there are too few.
inline constexpr double kUsualRidge = 2;

/// Per control: 1 - error / energy of the sentences, 0 for a constant control.
std::vector<double> explained_by(const CurveErrors& errors);

/// Sentences that were kept and sentences that were held out, for the choice of the ridge. The
/// controls may be others than those of the model (principal components), as long as the sum of
/// their errors is the same.
struct RidgeTrial {
  const LowerTriangle& gram;      ///< of what was kept
  std::span<const double> right;  ///< columns x controls
  std::size_t controls = 0;
  std::function<CurveErrors(const std::vector<double>&)> errors;  ///< of a solution on the others
};

/// Solves the same sums for several ridges at the cost of one.
class RidgeChooser {
 public:
  RidgeChooser(const LowerTriangle& kept, const TermSpace& space, const TermColumns& columns,
               double wanted, int threads);

  /// The largest factor among 2, 1 and 0.5 whose solution has an error on the held-out sentences
  /// within 0.5 % of the least; only the wanted one, if it is above 0. Before each factor `go_on`,
  /// if any, gets the share that is done; false stops, and the result is 0.
  double choose(const RidgeTrial& trial, const std::function<bool(double)>& go_on = {}) const;

  /// explained_by() on the held-out sentences with that factor.
  std::vector<double> explained(const RidgeTrial& trial, double factor) const;

 private:
  std::vector<double> solution(const RidgeTrial& trial, double factor,
                               std::vector<double> start) const;

  const TermSpace& space_;
  const TermColumns& columns_;
  std::vector<double> factors_;
  RidgeSolver solver_;
  int threads_;
};

/// Distance of the training means from rest, in standard deviations.
std::vector<double> means_from_rest(std::span<const Control> controls);

/// The model's tables. Curves were measured from the training mean, the model's are from rest.
RefinedParameters refined_parameters(const TermSpace& space, const std::vector<double>& curves,
                                     const std::vector<double>& means,
                                     const RefinedOptions& options,
                                     std::vector<PhoneDominance> dominance);

}  // namespace animeme::dam
