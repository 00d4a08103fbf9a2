// What both steps of the dominance fit see of a sentence, and the phones' own curves that are best
// for a dominance. Internal.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "dam/kinds/refined/fit.h"
#include "dam/maths/parallel.h"

namespace animeme::dam {

/// Unknowns of the phones' own curves.
inline std::size_t unknowns_of(const RefinedData& data) {
  return data.phones.size() * kRefinedOrders;
}

/// Everything about one sentence that sums need.
class SentenceView {
 public:
  SentenceView(const RefinedData& data, const FitSentence& sentence,
               std::span<const PhoneDominance> dominance)
      : data_(data), sentence_(sentence), design_(make_refined_design(data, sentence, dominance)) {
    for (std::size_t i = 0; i < sentence.frames; ++i)
      if (data.speech->use[sentence.first_frame + i] != 0) used_.push_back(i);
  }
  std::span<const std::size_t> used() const { return used_; }
  std::span<const RefinedPart> parts(std::size_t i) const { return design_.frame(i); }
  /// Divisor of the products of sums.
  double offset() const { return double(used_.size()) + data_.offset_frames; }

  /// The controls of a frame.
  const double* target(std::size_t i) const {
    return &data_.target[(sentence_.first_frame + i) * data_.controls];
  }

 private:
  const RefinedData& data_;
  const FitSentence& sentence_;
  RefinedDesign design_;
  std::vector<std::size_t> used_;
};

/// Adds the numbers up, place by place.
inline void add_all(std::vector<double>& sums, const std::vector<double>& others) {
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += others[i];
}

/// Sums are split into so many parts, whatever the threads.
inline constexpr std::size_t kSumParts = 8;

/// Runs over all sentences in kSumParts pieces and adds the pieces up in their order.
template <class Sums, class Add>
Sums sum_over(const RefinedData& data, const Sums& zero, const Add& add) {
  const std::size_t count = data.speech->sentences.size();
  std::vector<Sums> parts(std::min(kSumParts, count), zero);
  parallel_for(parts.size(), data.threads, [&](std::size_t p) {
    for (std::size_t s = p * count / parts.size(); s < (p + 1) * count / parts.size(); ++s)
      add(data.speech->sentences[s], parts[p]);
  });
  for (std::size_t p = 1; p < parts.size(); ++p) parts[0] += parts[p];
  return std::move(parts[0]);
}

/// Best own curves for a dominance.
struct Base {
  std::vector<double> factor;  ///< Cholesky factor of the normal equations, ridge included
  std::vector<double> curves;  ///< unknowns x controls
  double objective = 0;        ///< squared error + ridge
};

Base solve_base(const RefinedData& data, const DominanceOptions& options,
                std::span<const PhoneDominance> dominance);

}  // namespace animeme::dam
