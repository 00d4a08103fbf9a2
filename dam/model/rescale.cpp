#include "dam/model/rescale.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "dam/signal/fap_signal.h"

namespace animeme::dam {
namespace {

/// All numbers of a list in which every so-manieth belongs to one control.
template <class Number>
void turn(std::vector<Number>& values, std::size_t control, std::size_t controls) {
  for (std::size_t i = control; i < values.size(); i += controls) values[i] = -values[i];
}

/// Turns the curves of a control round.
struct Turn {
  std::size_t control, controls;

  void operator()(AnimemeParameters& parameters) const {
    for (AnimemePhone& phone : parameters.phones)
      for (Mode& mode : phone.modes) turn(mode.coefficients, control, controls);
  }
  void operator()(RefinedParameters& parameters) const {
    for (TermTable& table : parameters.tables) turn(table.values, control, controls);
  }
  void operator()(TrajectoryParameters& parameters) const {
    turn(parameters.mean, control, controls);
  }
  void operator()(MeanParameters&) const {}
  void operator()(VisemeParameters& parameters) const { turn(parameters.poses, control, controls); }
  void operator()(TriphoneParameters& parameters) const {
    for (ContextCurve& curve : parameters.curves) turn(curve.values, control, controls);
  }
};

void rescale_limits(Model& model, std::span<const GainOffset> gains) {
  if (model.limits.empty()) return;
  std::vector<std::string> names;
  for (const Control& control : model.controls) names.push_back(control.name);
  const auto natural = natural_limits(names);
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (!natural[c].free()) continue;
    ControlLimit& limit = model.limits[c];
    const auto [gain, offset] = std::pair(gains[c].gain, gains[c].offset);
    if (gain == 0) {  // nothing moves, whatever the bounds were
      limit.low = limit.high = offset;
    } else {
      limit.low = gain * limit.low + offset;
      limit.high = gain * limit.high + offset;
      if (gain < 0) std::swap(limit.low, limit.high);
    }
    limit.shared *= std::abs(gain);
  }
  untie(model.limits, [&](std::size_t a, std::size_t b) {
    const bool named = !natural[a].free() && !natural[b].free();
    const bool plain =
        gains[a].offset == 0 && gains[b].offset == 0 && gains[a].gain > 0 && gains[b].gain > 0;
    return named || plain;
  });
  for (ControlLimit& limit : model.limits) {  // one number for both of a pair
    if (limit.opposite < 0) continue;
    ControlLimit& other = model.limits[std::size_t(limit.opposite)];
    limit.shared = other.shared = std::max(limit.shared, other.shared);
  }
  model.limits = settled(std::move(model.limits));
}

}  // namespace

Result<void> rescale(Model& model, std::span<const GainOffset> gains) {
  if (gains.size() != model.controls.size())
    return make_error(Code::invalid_argument,
                      "the number of gains differs from the number of controls");
  for (const GainOffset& one : gains)
    if (!std::isfinite(one.gain) || !std::isfinite(one.offset))
      return make_error(Code::invalid_argument, "a gain or an offset is not a finite number");
  for (std::size_t c = 0; c < gains.size(); ++c) {
    const auto [gain, offset] = std::pair(gains[c].gain, gains[c].offset);
    Control& control = model.controls[c];
    control.rest = gain * control.rest + offset;
    control.mean = gain * control.mean + offset;
    control.sd *= std::abs(gain);
    if (gain < 0) std::visit(Turn{c, gains.size()}, model.parameters);
    if (fap_of_channel(control.name) == 5 && model.lip_tooth_raise)
      model.lip_tooth_raise = gain * *model.lip_tooth_raise + offset;
  }
  rescale_limits(model, gains);
  return {};
}

}  // namespace animeme::dam
