#include "dam/evaluate.h"

#include <algorithm>
#include <cmath>

#include "dam/closure.h"
#include "dam/detail/statistics.h"
#include "dam/fap_signal.h"

namespace animeme::dam {
namespace {

constexpr double kFalseMargin = 0.060;  // seconds

/// Running sums for the comparison of two series.
struct Comparison {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0, error = 0, largest = 0;

  void add(double a, double b) {
    n += 1;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
    error += (a - b) * (a - b);
    largest = std::max(largest, std::abs(a - b));
  }
  double rmse() const { return n > 0 ? std::sqrt(error / n) : 0; }
  double correlation() const {
    const double vx = xx - x * x / n, vy = yy - y * y / n;
    if (!(n > 0) || !(vx > 1e-12 * xx) || !(vy > 1e-12 * yy)) return 0;
    return (xy - x * y / n) / std::sqrt(vx * vy);
  }
};

/// A measure that is a weighted sum of channels.
struct Measure {
  const char* name;
  std::vector<std::pair<std::size_t, double>> channels;
  Comparison sums{};

  double at(const Signal& signal, std::size_t frame) const {
    double sum = 0;
    for (const auto& [channel, weight] : channels) sum += weight * signal.at(frame, channel);
    return sum;
  }
};

std::vector<Measure> find_measures(const Signal& signal) {
  const auto find = [&](int fap) {
    for (std::size_t c = 0; c < signal.names.size(); ++c)
      if (fap_of_channel(signal.names[c]) == fap) return std::ptrdiff_t(c);
    return std::ptrdiff_t(-1);
  };
  std::vector<Measure> found;
  const auto add = [&](const char* name, std::initializer_list<std::pair<int, double>> parts) {
    Measure measure{name, {}};
    for (const auto& [fap, weight] : parts) {
      if (find(fap) < 0) return;
      measure.channels.emplace_back(std::size_t(find(fap)), weight);
    }
    found.push_back(std::move(measure));
  };
  add("inner_gap", {{4, -1}, {5, -1}});
  add("width", {{6, 1}, {7, 1}});
  add("jaw", {{3, 1}});
  return found;
}

/// The recording with the model's controls only, in the model's order.
Result<Signal> recorded(const Model& model, const Utterance& u) {
  Signal out;
  out.rate = u.signal.rate;
  out.measured = u.signal.measured;
  std::vector<std::size_t> from;
  for (const Control& control : model.controls) {
    const auto at = std::find(u.signal.names.begin(), u.signal.names.end(), control.name);
    if (at == u.signal.names.end())
      return make_error(Code::not_found, "sentence '" + u.id + "' has no control '" + control.name +
                                             "' of the model");
    from.push_back(std::size_t(at - u.signal.names.begin()));
    out.names.push_back(control.name);
  }
  for (std::size_t i = 0; i < u.signal.frames(); ++i)
    for (const std::size_t c : from) out.values.push_back(u.signal.at(i, c));
  return out;
}

class Scorer {
 public:
  Scorer(const Model& model, const EvaluateOptions& options)
      : model_(model),
        options_(options),
        controls_(model.controls.size()),
        still_error_(model.controls.size(), 0.0) {
    bool any = false;
    for (const Control& c : model.controls) {
      scored_.push_back(is_scored_lip_fap(c.name) && c.sd > 0);
      any = any || scored_.back();
    }
    for (std::size_t c = 0; !any && c < scored_.size(); ++c) scored_[c] = model.controls[c].sd > 0;
  }

  Result<void> add(const Utterance& u) {
    const auto reference = recorded(model_, u);
    if (!reference) return reference.error();
    SynthesisOptions synthesis = options_.synthesis;
    synthesis.rate = u.signal.rate;
    synthesis.frames = u.signal.frames();
    const auto made = synthesise(model_, u.script, synthesis);
    if (!made)
      return make_error(made.error().code, "sentence '" + u.id + "': " + made.error().message);
    if (measures_.empty()) measures_ = find_measures(*made);
    compare(u, *reference, *made);
    compare_closures(u, *reference, *made);
    return {};
  }

  Result<Evaluation> finish() {
    if (result_.frames == 0)
      return make_error(Code::invalid_argument, "there is no measured frame of speech to score");
    double n = 0;
    for (std::size_t c = 0; c < controls_.size(); ++c) {
      const double sd = model_.controls[c].sd;
      const double nrmse = sd > 0 ? controls_[c].rmse() / sd : 0.0;
      result_.controls.push_back({model_.controls[c].name, scored_[c], controls_[c].rmse(), nrmse,
                                  controls_[c].largest, controls_[c].correlation()});
      if (!scored_[c]) continue;
      n += 1;
      result_.nrmse += nrmse;
      result_.still_nrmse += std::sqrt(still_error_[c] / double(result_.frames)) / sd;
      result_.correlation += controls_[c].correlation();
    }
    result_.nrmse /= std::max(1.0, n);
    result_.still_nrmse /= std::max(1.0, n);
    result_.correlation /= std::max(1.0, n);
    result_.l2 /= double(result_.frames);
    for (const Measure& m : measures_)
      result_.measures.push_back({m.name, m.sums.rmse(), m.sums.correlation()});
    ClosureScore& closure = result_.closure;
    const double phones = std::max(1.0, double(closure.phones));
    closure.measured /= phones;
    closure.predicted /= phones;
    closure.false_per_minute = seconds_ > 0 ? double(closure.false_closures) * 60 / seconds_ : 0;
    return std::move(result_);
  }

 private:
  void compare(const Utterance& u, const Signal& reference, const Signal& made) {
    const auto speech = speech_frames(u);
    UtteranceScore score{u.id, 0, 0, 0};
    std::vector<Comparison> own(controls_.size());
    for (std::size_t i = 0; i < made.frames(); ++i) {
      if (!speech[i]) continue;
      ++score.frames;
      double norm = 0;
      for (std::size_t c = 0; c < controls_.size(); ++c) {
        const double a = made.at(i, c), b = reference.at(i, c);
        controls_[c].add(a, b);
        still_error_[c] += std::pow(b - model_.controls[c].mean, 2);
        own[c].add(a, b);
        if (scored_[c]) norm += std::pow((a - b) / model_.controls[c].sd, 2);
      }
      score.l2 += std::sqrt(norm);
      for (Measure& m : measures_) m.sums.add(m.at(made, i), m.at(reference, i));
    }
    ++result_.utterances;
    result_.frames += score.frames;
    result_.l2 += score.l2;
    seconds_ += made.rate.seconds(double(score.frames));
    double n = 0;
    for (std::size_t c = 0; c < own.size(); ++c) {
      if (!scored_[c]) continue;
      n += 1;
      score.nrmse += own[c].rmse() / model_.controls[c].sd;
    }
    score.nrmse /= std::max(1.0, n);
    score.l2 /= std::max(1.0, double(score.frames));
    result_.per_utterance.push_back(std::move(score));
  }

  void compare_closures(const Utterance& u, const Signal& reference, const Signal& made) {
    const auto lips = inner_lip_channels(made.names);
    if (!lips) return;
    const auto closed = [&](const Signal& s, std::size_t i) {
      return inner_gap(s, i, *lips) < options_.closed_gap;
    };
    std::vector<bool> elsewhere(made.frames(), false);  // speech away from bilabials
    for (const Phone& phone : u.script.phones) {
      const FrameSpan span = frames_near(made, phone, 0);
      if (phone.label != kSilence)
        for (std::size_t i = span.first; i < span.last; ++i) elsewhere[i] = true;
    }
    for (const Phone& phone : u.script.phones) {
      if (!is_bilabial(phone.label) && phone.label != kSilence) continue;
      const FrameSpan near = frames_near(made, phone, kFalseMargin);
      for (std::size_t i = near.first; i < near.last; ++i) elsewhere[i] = false;
      if (phone.label == kSilence) continue;
      bool predicted = false, measured = false;
      const FrameSpan span = frames_near(made, phone, kClosureSearch);
      for (std::size_t i = span.first; i < span.last; ++i) {
        predicted = predicted || closed(made, i);
        measured = measured || closed(reference, i);
      }
      ++result_.closure.phones;
      result_.closure.predicted += predicted ? 1 : 0;
      result_.closure.measured += measured ? 1 : 0;
    }
    for (std::size_t i = 0; i < made.frames();) {
      bool run = false, real = false;
      for (; i < made.frames() && elsewhere[i] && closed(made, i); ++i) {
        run = true;
        real = real || closed(reference, i);
      }
      if (run && !real) ++result_.closure.false_closures;
      if (!run) ++i;
    }
  }

  const Model& model_;
  const EvaluateOptions& options_;
  std::vector<Comparison> controls_;
  std::vector<double> still_error_;  // squared, of the mean pose
  std::vector<bool> scored_;
  std::vector<Measure> measures_;
  double seconds_ = 0;
  Evaluation result_;
};

}  // namespace

bool is_scored_lip_fap(std::string_view name) {
  const int fap = fap_of_channel(name);
  return (fap >= 3 && fap <= 13) || (fap >= 51 && fap <= 60);
}

Result<Evaluation> evaluate(const Model& model, std::span<const Utterance> utterances,
                            const EvaluateOptions& options) {
  if (utterances.empty())
    return make_error(Code::invalid_argument, "there is no sentence to evaluate");
  Scorer scorer(model, options);
  for (const Utterance& u : utterances)
    if (auto ok = scorer.add(u); !ok) return ok.error();
  return scorer.finish();
}

}  // namespace animeme::dam
