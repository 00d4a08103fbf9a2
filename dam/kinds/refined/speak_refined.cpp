#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "dam/kinds/refined/dominance.h"
#include "dam/kinds/refined/refined.h"
#include "dam/kinds/refined/terms.h"
#include "dam/maths/raised_cosine.h"
#include "dam/signal/articulators_internal.h"
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
    here.next_duration = t[j + 1].paced();
    if (!t[j + 1].right.empty()) here.right_2 = phone_at(j + 2);
  }
  return here;
}

/// Least squares draw curves together where the recordings differ, so they are slower than these.
/// A frame is moved away from the mean of its surroundings by a share of the distance. Scripts tell
/// less of the corners of the mouth than of jaw and lips, so these are slowed down more. Seconds of
/// the surroundings on each side, weighted by a raised cosine. `dam/measured.md` has the choice.
constexpr double kSharpeningReach = 0.12;
constexpr double sharpening_of(Articulator articulator) {
  switch (articulator) {
    case Articulator::jaw:
      return 0.3;
    case Articulator::lips:
      return 0.25;
    case Articulator::width:
      return 0.8;
    case Articulator::corners:
      return 0.45;
    default:
      return 0.35;
  }
}

/// The row of a key in ascending keys; their number if it is not there. Without branches, which
/// nobody could foresee: half of the time of a phone went into finding its terms.
std::size_t row_of_key(std::span<const std::uint32_t> keys, std::uint32_t key) {
  const std::uint32_t* first = keys.data();
  std::size_t left = keys.size();
  while (left > 1) {
    const std::size_t half = left / 2;
    first += std::size_t(first[half - 1] < key) * half;
    left -= half;
  }
  return left == 1 && *first == key ? std::size_t(first - keys.data()) : keys.size();
}

/// Curves of single precision: their error is far below one FAP unit, and twice as many fit
/// into a vector unit.
class Voice {
 public:
  explicit Voice(const Speech& speech)
      : speech_(speech),
        parameters_(std::get<RefinedParameters>(speech.model.parameters)),
        controls_(speech.model.controls.size()),
        curve_(kRefinedOrders * controls_),
        before_(controls_),
        after_(controls_),
        kernel_(surroundings(speech)),
        sharpening_(sharpening(speech)),
        first_(double(speech.first_frame) - double(kernel_.size())),
        frames_(speech.frames + 2 * kernel_.size()),
        sum_(frames_, 0.0),
        blend_(frames_ * controls_, 0.0F) {}

  /// Occurrences come in their order.
  void add(std::size_t j) {
    const Occurrence& o = speech_.timeline[j];
    const double since =
        clock_.since(o.start, o.end(), is_silence(speech_.model.phones, speech_.phone[j]));
    const PhoneDominance& d = parameters_.dominance[std::size_t(speech_.phone[j])];
    const double rate = speech_.rate.frames_per_second();
    const std::size_t first = limited(std::ceil((o.start - reach_before(d)) * rate));
    const std::size_t last = limited(std::floor((o.end() + reach_after(d)) * rate) + 1);
    if (first >= last) return;
    const PhoneModel& phone = speech_.model.phones[std::size_t(speech_.phone[j])];
    const double strength =
        d.strength * duration_strength(o.paced(), phone.duration, parameters_.duration_exponent);
    make_curve(j, since);
    const double margin = parameters_.time_margin;
    for (std::size_t i = first; i < last; ++i) {
      const double t = speech_.rate.seconds(first_ + double(i));
      const double weight =
          strength * fall_off(d, std::max(0.0, o.start - t), std::max(0.0, t - o.end()));
      sum_[i] += weight;
      const double u = o.local(t);
      float* out = &blend_[i * controls_];
      if (u <= -margin) {
        add_pose(float(weight), before_, out);
      } else if (u >= 1 + margin) {
        add_pose(float(weight), after_, out);
      } else {
        double basis[kRefinedOrders];
        refined_basis(u, margin, basis);
        add_frame(weight, basis, out);
      }
    }
  }

  /// What is left over of a frame when its surroundings are taken off is made larger.
  void finish(std::span<double> rows) {
    for (std::size_t i = 0; i < frames_; ++i) {
      const auto scale = float(1 / std::max(sum_[i], 1e-12));
      for (std::size_t c = 0; c < controls_; ++c) blend_[i * controls_ + c] *= scale;
    }
    const std::size_t beside = kernel_.size();
    std::vector<float> around(controls_);
    for (std::size_t i = 0; i < speech_.frames; ++i) {
      const float* here = &blend_[(i + beside) * controls_];
      double* out = &rows[i * controls_];
      std::fill(around.begin(), around.end(), 0.0F);
      for (std::size_t k = 0; k < beside; ++k)
        add_differences(kernel_[k], here, here - (k + 1) * controls_, here + (k + 1) * controls_,
                        around.data());
      for (std::size_t c = 0; c < controls_; ++c)
        out[c] = double(here[c]) + double(sharpening_[c] * around[c]);
    }
  }

 private:
  /// Weights in the mean of the surroundings of the frames on each side, the nearest first.
  static std::vector<float> surroundings(const Speech& speech) {
    const double reach = kSharpeningReach * speech.rate.frames_per_second();
    std::vector<float> kernel;
    double sum = 1;
    for (double k = 1; speech.options.sharpness > 0 && k < reach; ++k) {
      kernel.push_back(float(raised_bell(k / reach)));
      sum += 2 * double(kernel.back());
    }
    for (float& weight : kernel) weight /= float(sum);
    return kernel;
  }
  /// Per control: the share of the distance from the mean of the surroundings that is added.
  static std::vector<float> sharpening(const Speech& speech) {
    std::vector<float> gain;
    for (const Control& control : speech.model.controls)
      gain.push_back(float(sharpening_of(articulator_of(control.name)) * speech.options.sharpness));
    return gain;
  }
  void add_differences(float weight, const float* __restrict here, const float* __restrict before,
                       const float* __restrict after, float* __restrict sum) const {
    for (std::size_t c = 0; c < controls_; ++c)
      sum[c] += weight * (2 * here[c] - before[c] - after[c]);
  }

  /// A frame of the clip, counted from the first that is made.
  std::size_t limited(double frame) const {
    return std::size_t(std::clamp(frame - first_, 0.0, double(frames_)));
  }

  /// All terms of an occurrence added up: kRefinedOrders x controls.
  void make_curve(std::size_t j, double since) {
    std::fill(curve_.begin(), curve_.end(), 0.0F);
    Neighbourhood here = neighbourhood(speech_, j);
    here.since = since;
    const auto uses = terms_of(speech_.model.phones, here);
    for (const TermTable& table : parameters_.tables) {
      const TermUse& use = uses[std::size_t(table.term)];
      if (use.scale == 0) continue;
      const std::size_t row = row_of_key(table.keys, use.key);
      if (row == table.keys.size()) continue;
      add_row(float(use.scale), &table.values[row * table.orders * controls_],
              table.orders * controls_, curve_.data());
    }
    // Most frames in reach lie beyond the margins, where the curve stands still.
    make_pose(-parameters_.time_margin, before_);
    make_pose(1 + parameters_.time_margin, after_);
  }

  static void add_row(float scale, const float* __restrict from, std::size_t count,
                      float* __restrict to) {
    for (std::size_t i = 0; i < count; ++i) to[i] += scale * from[i];
  }

  /// The curve at a local time.
  void make_pose(double u, std::vector<float>& pose) const {
    std::fill(pose.begin(), pose.end(), 0.0F);
    double basis[kRefinedOrders];
    refined_basis(u, parameters_.time_margin, basis);
    add_frame(1, basis, pose.data());
  }
  void add_pose(float weight, const std::vector<float>& pose, float* out) const {
    add_row(weight, pose.data(), controls_, out);
  }

  void add_frame(double weight, const double* basis, float* __restrict out) const {
    float w[kRefinedOrders];
    for (std::size_t m = 0; m < kRefinedOrders; ++m) w[m] = float(weight * basis[m]);
    const float* __restrict a = curve_.data();
    const std::size_t k = controls_;
    for (std::size_t c = 0; c < k; ++c)
      out[c] += w[0] * a[c] + w[1] * a[k + c] + w[2] * a[2 * k + c] + w[3] * a[3 * k + c] +
                w[4] * a[4 * k + c];
  }

  const Speech& speech_;
  const RefinedParameters& parameters_;
  SpeechClock clock_;
  std::size_t controls_;
  std::vector<float> curve_;           // of an occurrence: orders x controls
  std::vector<float> before_, after_;  // the curve where it stands still
  std::vector<float> kernel_, sharpening_;
  double first_;  // frame; those beside the wanted ones are needed to sharpen these
  std::size_t frames_;
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
  return reach + kSharpeningReach;
}

}  // namespace animeme::dam
