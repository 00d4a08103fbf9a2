#include "dam/detail/choose_modes.h"

#include "dam/animeme.h"
#include "dam/detail/contexts.h"
#include "dam/detail/mode_graph.h"

namespace animeme::dam {
namespace {

/// Value, slope and curvature by local time of all controls at one end of a mode.
struct EndState {
  std::vector<double> value, slope, curvature;
};

EndState end_state(const Model& model, const Mode& mode, double u) {
  const std::size_t controls = model.controls.size();
  std::vector<double> a(model.order + 1);
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
  explicit Ends(const Model& model) : model_(model), cache_(model.phones.size()) {}

  const EndState& get(std::int32_t phone, std::size_t mode, bool at_end) {
    auto& list = cache_[std::size_t(phone)];
    const PhoneModel& p = model_.phones[std::size_t(phone)];
    if (list.empty())
      for (const Mode& m : p.modes) {
        list.push_back(end_state(model_, m, 0));
        list.push_back(end_state(model_, m, 1));
      }
    return list[2 * mode + (at_end ? 1 : 0)];
  }

 private:
  const Model& model_;
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
  return sum;
}

}  // namespace

std::vector<std::size_t> choose_modes(const Model& model, const std::vector<Occurrence>& timeline,
                                      double context_weight, double smoothness_weight) {
  const auto classes = context_classes(model);
  const double rate = model.rate.frames_per_second();
  std::vector<std::int32_t> phone;
  for (const Occurrence& o : timeline) phone.push_back(model.find_phone(o.label));
  ModeGraph graph;
  for (std::size_t j = 0; j < timeline.size(); ++j) {
    const auto neighbour = [&](const std::string& label) {
      return label.empty() ? kRestContext : model.find_phone(label);
    };
    graph.node.push_back(mode_costs(model.phones[std::size_t(phone[j])], classes,
                                    neighbour(timeline[j].left), neighbour(timeline[j].right)));
    for (double& cost : graph.node.back()) cost *= context_weight;
  }
  Ends ends(model);
  graph.edge = [&](std::size_t j, std::size_t from, std::size_t to) {
    // A single edge between two layers is no choice; a rest in between needs no smoothness.
    const bool choice = graph.node[j - 1].size() * graph.node[j].size() > 1;
    if (!choice || smoothness_weight == 0 || timeline[j].left.empty()) return 0.0;
    return smoothness_weight * jump(ends.get(phone[j - 1], from, true),
                                    timeline[j - 1].duration * rate, ends.get(phone[j], to, false),
                                    timeline[j].duration * rate);
  };
  return cheapest_path(graph).mode;
}

}  // namespace animeme::dam
