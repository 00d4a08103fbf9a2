// From sums to the parameters of a model: what is the same whether the sums were taken in one go or
// in parts. Internal.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "dam/corpus/train_options.h"
#include "dam/kinds/refined/curves_fit.h"
#include "dam/model/model.h"

namespace animeme::dam {

struct RidgeChoice {
  double factor = 1;
  std::vector<double> explained;  ///< explained_by() on the sentences that were held out
};

/// One sentence of so many is held out to choose the ridge, if there are twice as many at least.
inline constexpr std::size_t kHeldOut = 8;
inline constexpr std::size_t kLeastToChoose = 2 * kHeldOut;
/// The factor where there are too few.
inline constexpr double kUsualRidge = 2;

/// Per control: 1 - error / energy of the sentences that were summed, 0 for a constant control.
std::vector<double> explained_by(const CurveSums& sums, const std::vector<double>& errors);

/// The largest factor among 2, 1 and 0.5 whose curves for `kept` have an error on `held` within
/// 0.5 % of the least; only `wanted`, if it is above 0. Before each of them, which take long,
/// `go_on`, if any, gets the share that is done; false stops, and the result is none.
RidgeChoice choose_ridge(const CurveSums& kept, const CurveSums& held, const TermSpace& space,
                         std::size_t controls, double wanted, int threads, SquareMatrix& work,
                         const std::function<bool(double)>& go_on = {});

/// Distance of the training means from rest, in standard deviations.
std::vector<double> means_from_rest(std::span<const Control> controls);

/// The model's tables. Curves were measured from the training mean, the model's are from rest.
RefinedParameters refined_parameters(const TermSpace& space, const std::vector<double>& curves,
                                     const std::vector<double>& means,
                                     const RefinedOptions& options,
                                     std::vector<PhoneDominance> dominance);

}  // namespace animeme::dam
