#include <algorithm>
#include <cmath>

#include "dam/kinds/animeme/animemes.h"
#include "dam/kinds/animeme/contexts.h"
#include "dam/kinds/animeme/mode_graph.h"
#include "dam/model/animeme.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

/// Value, slope and curvature by local time of all controls at one end of a mode.
struct EndState {
  std::vector<double> value, slope, curvature;
};

EndState end_state(const Mode& mode, std::size_t terms, double u) {
  const std::size_t controls = mode.coefficients.size() / terms;
  std::vector<double> a(terms);
  EndState state;
  for (std::size_t c = 0; c < controls; ++c) {
    for (std::size_t m = 0; m < a.size(); ++m) a[m] = mode.coefficients[m * controls + c];
    state.value.push_back(polynomial(a, u));
    state.slope.push_back(polynomial_slope(a, u));
    state.curvature.push_back(polynomial_curvature(a, u));
  }
  return state;
}

/// The ends of all modes of a model, made when first asked for.
class Ends {
 public:
  explicit Ends(const AnimemeParameters& parameters)
      : parameters_(parameters), cache_(parameters.phones.size()) {}

  const EndState& get(std::int32_t phone, std::size_t mode, bool at_end) {
    auto& list = cache_[std::size_t(phone)];
    if (list.empty())
      for (const Mode& m : parameters_.phones[std::size_t(phone)].modes) {
        list.push_back(end_state(m, parameters_.order + 1, 0));
        list.push_back(end_state(m, parameters_.order + 1, 1));
      }
    return list[2 * mode + (at_end ? 1 : 0)];
  }

 private:
  const AnimemeParameters& parameters_;
  std::vector<std::vector<EndState>> cache_;
};

double jump(const EndState& before, double frames_before, const EndState& after,
            double frames_after) {
  const double s0 = 1 / frames_before, s1 = 1 / frames_after;
  double sum = 0;
  for (std::size_t c = 0; c < before.value.size(); ++c) {
    const double v = after.value[c] - before.value[c];
    const double d = after.slope[c] * s1 - before.slope[c] * s0;
    const double dd = after.curvature[c] * s1 * s1 - before.curvature[c] * s0 * s0;
    sum += v * v + d * d + dd * dd;
  }
  // A path needs finite costs, also if a model's coefficients are absurd.
  constexpr double kLargest = 1e100;
  return sum < kLargest ? sum : kLargest;
}

/// Which mode every phone of a script takes: the costs of Eq. 10 on the animeme graph.
///   E   = context_weight * E_c + smoothness_weight * E_s (SynthesisOptions)
///   E_c = -log P(mode | neighbours), see contexts.h
///   E_s = sum over controls of the squared jumps of value, first and second derivative (per frame
///         of the training rate, in standard deviations) where two polynomials meet; 0 across a
///         rest
std::vector<std::size_t> choose_modes(const Speech& speech) {
  const Model& model = speech.model;
  const auto& parameters = std::get<AnimemeParameters>(model.parameters);
  const std::span<const Occurrence> timeline = speech.timeline;
  const std::span<const std::int32_t> phone = speech.phone;
  const double context_weight = speech.options.context_weight;
  const double smoothness_weight = speech.options.smoothness_weight;
  const auto classes = context_classes(model);
  const double rate = model.rate.frames_per_second();
  ModeGraph graph;
  for (std::size_t j = 0; j < timeline.size(); ++j) {
    graph.node.push_back(mode_costs(parameters.phones[std::size_t(phone[j])], classes,
                                    neighbour(model, timeline[j].left),
                                    neighbour(model, timeline[j].right)));
    for (double& cost : graph.node.back()) cost *= context_weight;
  }
  Ends ends(parameters);
  graph.edge = [&](std::size_t j, std::size_t from, std::size_t to) {
    // A single edge between two layers is no choice; a rest in between needs no smoothness.
    const bool choice = graph.node[j - 1].size() * graph.node[j].size() > 1;
    if (!choice || smoothness_weight == 0 || timeline[j].left.empty()) return 0.0;
    return smoothness_weight * jump(ends.get(phone[j - 1], from, true),
                                    timeline[j - 1].paced() * rate, ends.get(phone[j], to, false),
                                    timeline[j].paced() * rate);
  };
  return cheapest_path(graph).mode;
}

/// Eq. 2: adds D A of one occurrence to the frames in its reach, and D to `sums`.
void add_occurrence(const Speech& speech, const AnimemeParameters& model, const Mode& mode,
                    const Occurrence& o, std::span<double> rows, std::vector<double>& sums) {
  const std::size_t terms = model.order + 1, controls = speech.model.controls.size();
  const double reach = dominance_reach(mode.sigma) * o.paced();
  const auto [first, last] = speech.frames_between(o.start - reach, o.end() + reach);
  for (std::size_t i = first; i < last; ++i) {
    const double u = o.local(speech.time(i));
    const double v = clamp_local_time(u, model.time_margin);
    double* out = &rows[i * controls];
    double weight = dominance(u, mode.sigma);
    sums[i] += weight;
    for (std::size_t m = 0; m < terms; ++m, weight *= v) {
      const double* a = &mode.coefficients[m * controls];
      for (std::size_t c = 0; c < controls; ++c) out[c] += weight * a[c];
    }
  }
}

void normalise(const std::vector<double>& sums, std::size_t controls, std::span<double> rows) {
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (std::size_t c = 0; c < controls; ++c)
      rows[i * controls + c] /= std::max(sums[i], kLeastDominanceSum);
}

}  // namespace

double reach_of_animemes(const Model& model) {
  const auto& parameters = std::get<AnimemeParameters>(model.parameters);
  double reach = 0;
  for (std::size_t p = 0; p < model.phones.size(); ++p)
    for (const Mode& mode : parameters.phones[p].modes)
      reach = std::max(reach, dominance_reach(mode.sigma) * model.phones[p].longest);
  return reach;
}

void speak_animemes(const Speech& speech, std::span<double> rows, SynthesisReport& report) {
  const auto& parameters = std::get<AnimemeParameters>(speech.model.parameters);
  report.modes = choose_modes(speech);
  std::vector<double> sums(speech.frames, 0.0);
  for (std::size_t j = 0; j < speech.timeline.size(); ++j) {
    const AnimemePhone& phone = parameters.phones[std::size_t(speech.phone[j])];
    add_occurrence(speech, parameters, phone.modes[report.modes[j]], speech.timeline[j], rows,
                   sums);
  }
  if (parameters.normalised) normalise(sums, speech.model.controls.size(), rows);
}

}  // namespace animeme::dam
