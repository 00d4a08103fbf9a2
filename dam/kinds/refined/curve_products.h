// What the curves of one sentence need of its frames: a few numbers for each occurrence and each
// two that meet, from which the sums of all terms follow. Internal.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "dam/kinds/refined/fit.h"

namespace animeme::dam {

/// Products of the polynomials of two occurrences, column by column.
using CurveSquare = std::array<double, kRefinedOrders * kRefinedOrders>;

struct CurveProducts {
  /// Occurrences of the sentence that meet, the first not before the second, and the products of
  /// their weighted polynomials.
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<CurveSquare> squares;
  std::vector<double> own_sum;     ///< occurrences x kRefinedOrders
  std::vector<double> own_target;  ///< occurrences x kRefinedOrders x controls
  std::vector<double> target_sum;  ///< per control
  std::vector<double> energy;      ///< squared targets, per control
  double weight = 0;               ///< of all frames
  std::size_t frames = 0;          ///< those that have a weight
};

/// Of the frames of a sentence that have a weight (`weight`: of all frames of the data).
CurveProducts curve_products(const RefinedData& data, const FitSentence& sentence,
                             std::span<const PhoneDominance> dominance,
                             std::span<const float> weight);

}  // namespace animeme::dam
