#include <algorithm>
#include <cmath>

#include "dam/kinds/animeme/contexts.h"
#include "dam/kinds/animeme/modes.h"
#include "dam/model/animeme.h"

namespace animeme::dam {
namespace {

class Reassigner {
 public:
  Reassigner(FitData& data, const ModeTable& table, const FitState& state, double context_weight,
             std::span<const std::uint32_t> classes, const std::vector<AnimemePhone>& phones)
      : data_(data),
        table_(table),
        state_(state),
        weight_(context_weight),
        phones_(phones),
        members_(table.count(), 0),
        classes_(classes) {
    for (const FitOccurrence& o : data.occurrences) ++members_[o.mode];
  }

  std::size_t run() {
    std::size_t moves = 0;
    for (const FitSentence& sentence : data_.sentences) {
      const Design design = make_raw_design(data_, sentence, state_.sigma);
      numerator_ = predict(data_, state_, sentence, design);
      sum_.assign(sentence.frames, data_.normalised ? 0.0 : 1.0);
      for (std::size_t i = 0; data_.normalised && i < sentence.frames; ++i)
        for (const Part& part : design.frame(i)) sum_[i] += part.dominance;
      for (std::size_t j = 0; j < sentence.occurrences; ++j)
        moves += improve(sentence, data_.occurrences[sentence.first_occurrence + j]) ? 1 : 0;
    }
    return moves;
  }

 private:
  bool improve(const FitSentence& sentence, FitOccurrence& o) {
    const std::size_t first = table_.first[std::size_t(o.phone)], count = table_.of(o.phone);
    if (count < 2 || members_[o.mode] <= kSmallestMode) return false;
    const FrameRange window = window_of(sentence, o);
    const auto context = mode_costs(phones_[std::size_t(o.phone)], classes_, o.left, o.right,
                                    std::int32_t(o.mode - first));
    add_to_blend(window, o, o.mode, -1);
    std::uint32_t best = o.mode;
    double best_cost = cost(sentence, window, o, o.mode) + weight_ * context[o.mode - first];
    for (std::size_t g = 0; g < count; ++g) {
      const auto mode = std::uint32_t(first + g);
      if (mode == o.mode) continue;
      const double c = cost(sentence, window, o, mode) + weight_ * context[g];
      if (c < best_cost) {
        best_cost = c;
        best = mode;
      }
    }
    add_to_blend(window, o, best, +1);
    if (best == o.mode) return false;
    --members_[o.mode];
    ++members_[best];
    o.mode = best;
    return true;
  }

  /// Frames within reach of an occurrence under any of its phone's modes.
  FrameRange window_of(const FitSentence& sentence, const FitOccurrence& o) const {
    double sigma = 0;
    for (std::size_t g = 0; g < table_.of(o.phone); ++g)
      sigma = std::max(sigma, state_.sigma[table_.first[std::size_t(o.phone)] + g]);
    return reach_of(data_, sentence, o, sigma);
  }

  /// D A of one mode at one frame, into value_; D into weight_of_value_ (0 in a plain sum).
  void evaluate(const FitOccurrence& o, std::uint32_t mode, std::size_t frame) {
    const double u = (double(frame) / data_.rate - o.start) / o.duration;
    double basis[kMaxOrder + 1];
    legendre(u, data_.time_margin, data_.order, basis);
    const double d = dominance(u, state_.sigma[mode]);
    value_.assign(data_.controls, 0.0);
    weight_of_value_ = data_.normalised ? d : 0.0;
    for (std::size_t m = 0; m < data_.terms(); ++m) {
      const double* a = &state_.coefficients[(mode * data_.terms() + m) * data_.controls];
      for (std::size_t c = 0; c < data_.controls; ++c) value_[c] += d * basis[m] * a[c];
    }
  }

  /// Takes an occurrence into the sums of Eq. 2 (sign 1) or out of them (-1).
  void add_to_blend(const FrameRange& window, const FitOccurrence& o, std::uint32_t mode,
                    double sign) {
    for (std::size_t i = window.begin; i < window.end; ++i) {
      evaluate(o, mode, i);
      sum_[i] += sign * weight_of_value_;
      for (std::size_t c = 0; c < data_.controls; ++c)
        numerator_[i * data_.controls + c] += sign * value_[c];
    }
  }

  double cost(const FitSentence& sentence, const FrameRange& window, const FitOccurrence& o,
              std::uint32_t mode) {
    double sum = 0;
    for (std::size_t i = window.begin; i < window.end; ++i) {
      if (data_.use[sentence.first_frame + i] == 0) continue;
      evaluate(o, mode, i);
      const double total = std::max(sum_[i] + weight_of_value_, kLeastDominanceSum);
      const double* target = &data_.target[(sentence.first_frame + i) * data_.controls];
      for (std::size_t c = 0; c < data_.controls; ++c) {
        const double r = target[c] - (numerator_[i * data_.controls + c] + value_[c]) / total;
        sum += r * r;
      }
    }
    return sum;
  }

  FitData& data_;
  const ModeTable& table_;
  const FitState& state_;
  double weight_;
  const std::vector<AnimemePhone>& phones_;
  std::vector<std::size_t> members_;
  std::span<const std::uint32_t> classes_;
  std::vector<double> numerator_, sum_;  // of Eq. 2, per frame of the sentence
  std::vector<double> value_;
  double weight_of_value_ = 0;
};

}  // namespace

std::size_t reassign_modes(FitData& data, const ModeTable& table, const FitState& state,
                           double context_weight, std::span<const std::uint32_t> classes,
                           std::vector<AnimemePhone>& phones) {
  const std::size_t moves = Reassigner(data, table, state, context_weight, classes, phones).run();
  count_contexts(data, table, phones);
  return moves;
}

}  // namespace animeme::dam
