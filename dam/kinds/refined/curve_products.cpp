#include "dam/kinds/refined/curve_products.h"

#include <algorithm>

namespace animeme::dam {
namespace {

class Collector {
 public:
  Collector(const FitSentence& sentence, std::size_t controls, CurveProducts& out)
      : first_(sentence.first_occurrence),
        controls_(controls),
        out_(out),
        meet_(sentence.occurrences) {
    out.own_sum.assign(sentence.occurrences * kRefinedOrders, 0.0);
    out.own_target.assign(sentence.occurrences * kRefinedOrders * controls, 0.0);
    out.target_sum.assign(controls, 0.0);
    out.energy.assign(controls, 0.0);
  }

  void add(std::span<const RefinedPart> parts, const double* y, double weight) {
    out_.weight += weight;
    ++out_.frames;
    for (std::size_t c = 0; c < controls_; ++c) out_.energy[c] += weight * y[c] * y[c];
    add_row(out_.target_sum.data(), weight, y);
    for (const RefinedPart& a : parts) {
      const std::size_t ja = a.occurrence - first_;
      for (std::size_t m = 0; m < kRefinedOrders; ++m) {
        const double x = weight * a.weight * a.basis[m];
        out_.own_sum[ja * kRefinedOrders + m] += x;
        add_row(&out_.own_target[(ja * kRefinedOrders + m) * controls_], x, y);
      }
      for (const RefinedPart& b : parts)
        if (b.occurrence <= a.occurrence)
          add_pair(a, b, weight, out_.squares[slot_of(ja, b.occurrence - first_)]);
    }
  }

 private:
  void add_row(double* __restrict to, double scale, const double* __restrict from) const {
    for (std::size_t c = 0; c < controls_; ++c) to[c] += scale * from[c];
  }

  static void add_pair(const RefinedPart& a, const RefinedPart& b, double weight,
                       CurveSquare& square) {
    const double w = weight * a.weight * b.weight;
    for (std::size_t n = 0; n < kRefinedOrders; ++n)
      for (std::size_t m = 0; m < kRefinedOrders; ++m)
        square[n * kRefinedOrders + m] += w * a.basis[m] * b.basis[n];
  }

  /// A phone meets some ten others.
  std::size_t slot_of(std::size_t a, std::size_t b) {
    for (const auto& [other, slot] : meet_[a])
      if (other == b) return slot;
    meet_[a].emplace_back(b, out_.squares.size());
    out_.squares.push_back({});
    out_.pairs.emplace_back(a, b);
    return out_.squares.size() - 1;
  }

  std::size_t first_, controls_;
  CurveProducts& out_;
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> meet_;  // other, place
};

}  // namespace

CurveProducts curve_products(const RefinedData& data, const FitSentence& sentence,
                             std::span<const PhoneDominance> dominance,
                             std::span<const float> weight) {
  CurveProducts out;
  const auto own = weight.subspan(sentence.first_frame, sentence.frames);
  if (std::all_of(own.begin(), own.end(), [](float w) { return w == 0; })) return out;
  Collector collector(sentence, data.controls, out);
  const RefinedDesign design = make_refined_design(data, sentence, dominance);
  for (std::size_t i = 0; i < sentence.frames; ++i)
    if (own[i] != 0)
      collector.add(design.frame(i), &data.target[(sentence.first_frame + i) * data.controls],
                    own[i]);
  return out;
}

}  // namespace animeme::dam
