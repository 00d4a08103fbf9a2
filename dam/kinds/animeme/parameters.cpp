// Checks of the parameters, and their place in the model file.
#include <cmath>

#include "dam/kinds/animeme/animemes.h"
#include "dam/kinds/animeme/fit.h"

namespace animeme::dam {
namespace {

Result<void> check_contexts(const Model& model, const AnimemePhone& phone,
                            const std::string& label) {
  const auto limit = std::int32_t(model.phones.size());
  for (const ContextCount& c : phone.contexts)
    if (c.left < kRestContext || c.left >= limit || c.right < kRestContext || c.right >= limit ||
        c.mode >= phone.modes.size() || c.count == 0)
      return invalid_model("phone " + label + " has a context that does not exist");
  return {};
}

Result<void> check_phone(const Model& model, std::size_t coefficients, const AnimemePhone& phone,
                         const std::string& label) {
  if (phone.modes.empty()) return invalid_model("phone " + label + " has no mode");
  for (const Mode& mode : phone.modes) {
    if (!(mode.sigma > 0) || !(mode.sigma < 1e3))
      return invalid_model("phone " + label + " has a width out of range");
    if (mode.coefficients.size() != coefficients)
      return invalid_model("phone " + label + " has a wrong number of coefficients");
    for (const double a : mode.coefficients)
      if (!std::isfinite(a))
        return invalid_model("phone " + label + " has a coefficient without value");
  }
  return check_contexts(model, phone, label);
}

// In the file the coefficients of one control stand together: a^0 .. a^M of control 0, of control 1
// ...

void write_phone(ByteWriter& out, const AnimemePhone& phone, std::size_t controls) {
  out.count(phone.modes.size());
  for (const Mode& mode : phone.modes) {
    out.put(mode.sigma);
    for (std::size_t c = 0; c < controls; ++c)
      for (std::size_t i = c; i < mode.coefficients.size(); i += controls)
        out.put(mode.coefficients[i]);
  }
  out.count(phone.contexts.size());
  for (const ContextCount& c : phone.contexts) out.put(c.left, c.right, c.mode, c.count);
}

AnimemePhone read_phone(ByteReader& in, std::size_t controls, std::size_t coefficients) {
  AnimemePhone phone;
  phone.modes.resize(in.count(8 + 8 * coefficients));
  for (Mode& mode : phone.modes) {
    in.get(mode.sigma);
    mode.coefficients.resize(coefficients);
    for (std::size_t c = 0; c < controls; ++c)
      for (std::size_t i = c; i < coefficients; i += controls) in.get(mode.coefficients[i]);
  }
  phone.contexts.resize(in.count(16));
  for (ContextCount& c : phone.contexts) in.get(c.left, c.right, c.mode, c.count);
  return phone;
}

}  // namespace

Result<void> validate_animemes(const Model& model) {
  const auto* p = std::get_if<AnimemeParameters>(&model.parameters);
  if (p == nullptr) return invalid_model("its parameters are not those of its method");
  if (p->order > kMaxOrder) return invalid_model("the degree of its polynomials is above 8");
  if (model.method == Method::cohen_massaro && p->order != 0)
    return invalid_model("a target of cohen-massaro has more than one coefficient");
  if (!(p->time_margin >= 0)) return invalid_model("its time margin is negative");
  if (p->phones.size() != model.phones.size())
    return invalid_model("its phones and their modes differ in number");
  const std::size_t coefficients = (p->order + 1) * model.controls.size();
  for (std::size_t i = 0; i < p->phones.size(); ++i)
    if (auto ok = check_phone(model, coefficients, p->phones[i], model.phones[i].label); !ok)
      return ok;
  return {};
}

void write_animemes(const Model& model, ByteWriter& out) {
  const auto& p = std::get<AnimemeParameters>(model.parameters);
  out.put(p.order, std::uint8_t(p.normalised ? 1 : 0), p.time_margin);
  for (const AnimemePhone& phone : p.phones) write_phone(out, phone, model.controls.size());
}

Result<void> read_animemes(ByteReader& in, Model& model) {
  AnimemeParameters p;
  std::uint8_t blend = 0;
  in.get(p.order, blend, p.time_margin);
  if (blend > 1) return make_error(Code::syntax, "unknown blend");
  if (p.order > kMaxOrder) return make_error(Code::syntax, "degree out of range");
  p.normalised = blend == 1;
  const std::size_t coefficients = (p.order + 1) * model.controls.size();
  for (std::size_t i = 0; i < model.phones.size() && !in.failed(); ++i)
    p.phones.push_back(read_phone(in, model.controls.size(), coefficients));
  model.parameters = std::move(p);
  return {};
}

}  // namespace animeme::dam
