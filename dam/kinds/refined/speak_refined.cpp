#include <algorithm>
#include <cmath>

#include "dam/kinds/refined/dominance.h"
#include "dam/kinds/refined/refined.h"
#include "dam/kinds/refined/terms.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

Neighbourhood neighbourhood(const Speech& speech, std::size_t j) {
  const auto phone_at = [&](std::size_t i) { return speech.phone[i]; };
  const std::span<const Occurrence> t = speech.timeline;
  Neighbourhood here;
  here.phone = phone_at(j);
  here.duration = t[j].paced();
  if (!t[j].left.empty()) {
    here.left = phone_at(j - 1);
    if (!t[j - 1].left.empty()) here.left_2 = phone_at(j - 2);
  }
  if (!t[j].right.empty()) {
    here.right = phone_at(j + 1);
    if (!t[j + 1].right.empty()) here.right_2 = phone_at(j + 2);
  }
  return here;
}

/// Curves of single precision: their error is far below what a FAP can tell, and twice as many fit
/// into a vector unit.
class Voice {
 public:
  explicit Voice(const Speech& speech)
      : speech_(speech),
        parameters_(std::get<RefinedParameters>(speech.model.parameters)),
        controls_(speech.model.controls.size()),
        curve_(kRefinedOrders * controls_),
        sum_(speech.frames, 0.0),
        blend_(speech.frames * controls_, 0.0F) {}

  void add(std::size_t j) {
    const Occurrence& o = speech_.timeline[j];
    const PhoneDominance& d = parameters_.dominance[std::size_t(speech_.phone[j])];
    const auto [first, last] =
        speech_.frames_between(o.start - reach_before(d), o.end() + reach_after(d));
    if (first >= last) return;
    const PhoneModel& phone = speech_.model.phones[std::size_t(speech_.phone[j])];
    const double strength =
        d.strength * duration_strength(o.paced(), phone.duration, parameters_.duration_exponent);
    make_curve(j);
    for (std::size_t i = first; i < last; ++i) {
      const double t = speech_.time(i);
      const double weight =
          strength * fall_off(d, std::max(0.0, o.start - t), std::max(0.0, t - o.end()));
      double basis[kRefinedOrders];
      refined_basis(o.local(t), parameters_.time_margin, basis);
      sum_[i] += weight;
      add_frame(weight, basis, &blend_[i * controls_]);
    }
  }

  void finish(std::span<double> rows) const {
    for (std::size_t i = 0; i < speech_.frames; ++i) {
      const double scale = 1 / std::max(sum_[i], 1e-12);
      for (std::size_t c = 0; c < controls_; ++c)
        rows[i * controls_ + c] = double(blend_[i * controls_ + c]) * scale;
    }
  }

 private:
  /// All terms of an occurrence added up: kRefinedOrders x controls.
  void make_curve(std::size_t j) {
    std::fill(curve_.begin(), curve_.end(), 0.0F);
    const auto uses = terms_of(speech_.model.phones, neighbourhood(speech_, j));
    for (const TermTable& table : parameters_.tables) {
      const TermUse& use = uses[std::size_t(table.term)];
      const auto at = std::lower_bound(table.keys.begin(), table.keys.end(), use.key);
      if (at == table.keys.end() || *at != use.key) continue;
      const std::size_t values = table.orders * controls_;
      const float* from = &table.values[std::size_t(at - table.keys.begin()) * values];
      const auto scale = float(use.scale);
      for (std::size_t i = 0; i < values; ++i) curve_[i] += scale * from[i];
    }
  }

  void add_frame(double weight, const double* basis, float* out) const {
    float w[kRefinedOrders];
    for (std::size_t m = 0; m < kRefinedOrders; ++m) w[m] = float(weight * basis[m]);
    const float* a = curve_.data();
    const std::size_t k = controls_;
    for (std::size_t c = 0; c < k; ++c)
      out[c] += w[0] * a[c] + w[1] * a[k + c] + w[2] * a[2 * k + c] + w[3] * a[3 * k + c] +
                w[4] * a[4 * k + c];
  }

  const Speech& speech_;
  const RefinedParameters& parameters_;
  std::size_t controls_;
  std::vector<float> curve_;
  std::vector<double> sum_;
  std::vector<float> blend_;
};

}  // namespace

void speak_refined(const Speech& speech, std::span<double> rows, SynthesisReport&) {
  Voice voice(speech);
  for (std::size_t j = 0; j < speech.timeline.size(); ++j) voice.add(j);
  voice.finish(rows);
}

double reach_of_refined(const Model& model) {
  double reach = 0;
  for (const PhoneDominance& d : std::get<RefinedParameters>(model.parameters).dominance)
    reach = std::max({reach, reach_before(d), reach_after(d)});
  return reach;
}

}  // namespace animeme::dam
