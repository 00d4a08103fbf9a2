// Checks of the parameters, and their place in the model file.
#include <cmath>

#include "dam/kinds/trajectory/fit_control.h"
#include "dam/kinds/trajectory/trajectory.h"

namespace animeme::dam {
namespace {

constexpr std::uint32_t kMaxStates = 8;

bool all_within(const std::vector<double>& values, double low, double high) {
  for (const double v : values)
    if (!(v >= low && v <= high)) return false;
  return true;
}

}  // namespace

Result<void> validate_trajectory(const Model& model) {
  const auto* p = std::get_if<TrajectoryParameters>(&model.parameters);
  if (p == nullptr) return invalid_model("its parameters are not those of its method");
  if (p->states < 1 || p->states > kMaxStates)
    return invalid_model("its number of states per phone is out of range");
  if (p->order < 1 || p->order > kMaxDifference)
    return invalid_model("the order of its smoothness is out of range");
  const std::size_t controls = model.controls.size();
  const std::size_t values = model.phones.size() * p->states * controls;
  if (p->smoothness.size() != controls || p->mean.size() != values || p->variance.size() != values)
    return invalid_model("its number of Gaussians does not match its phones and controls");
  if (!all_within(p->smoothness, kLeastSmoothness, kLargestSmoothness))
    return invalid_model("a smoothness is out of range");
  if (!all_within(p->mean, -1e6, 1e6)) return invalid_model("a mean is out of range");
  if (!all_within(p->variance, kLeastVariance, kLargestVariance))
    return invalid_model("a variance is out of range");
  return {};
}

void write_trajectory(const Model& model, ByteWriter& out) {
  const auto& p = std::get<TrajectoryParameters>(model.parameters);
  out.put(p.states, p.order, p.smoothness);
  for (std::size_t i = 0; i < p.mean.size(); ++i) out.put(p.mean[i], p.variance[i]);
}

Result<void> read_trajectory(ByteReader& in, Model& model) {
  TrajectoryParameters p;
  in.get(p.states, p.order);
  if (p.states < 1 || p.states > kMaxStates)
    return make_error(Code::syntax, "number of states out of range");
  const std::size_t controls = model.controls.size();
  p.smoothness.resize(in.limited(controls, 8));
  in.get(p.smoothness);
  // The phones and controls are in memory already, but not their product.
  const std::size_t values = in.limited(model.phones.size() * p.states * controls, 16);
  p.mean.resize(values);
  p.variance.resize(values);
  for (std::size_t i = 0; i < values; ++i) in.get(p.mean[i], p.variance[i]);
  model.parameters = std::move(p);
  return {};
}

}  // namespace animeme::dam
