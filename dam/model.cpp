#include "dam/model.h"

#include <algorithm>
#include <cmath>

#include "fap/rate.h"

namespace animeme::dam {

std::string_view method_name(Method method) {
  switch (method) {
    case Method::dam_paper:
      return "dam-paper";
    case Method::dam:
      return "dam";
    case Method::cohen_massaro:
      return "cohen-massaro";
    case Method::mmm:
      return "mmm";
  }
  return "";
}

std::int32_t Model::find_phone(std::string_view label) const {
  const auto at = std::lower_bound(
      phones.begin(), phones.end(), label,
      [](const PhoneModel& p, std::string_view l) { return std::string_view(p.label) < l; });
  return at != phones.end() && at->label == label ? std::int32_t(at - phones.begin()) : -1;
}

std::int32_t Model::find_control(std::string_view name) const {
  for (std::size_t c = 0; c < controls.size(); ++c)
    if (controls[c].name == name) return std::int32_t(c);
  return -1;
}

namespace {

Error bad(const std::string& what) {
  return make_error(Code::invalid_argument, "the model is not valid: " + what);
}

Result<void> check_contexts(const Model& model, const PhoneModel& phone) {
  const auto limit = std::int32_t(model.phones.size());
  for (const ContextCount& c : phone.contexts)
    if (c.left < kRestContext || c.left >= limit || c.right < kRestContext || c.right >= limit ||
        c.mode >= phone.modes.size() || c.count == 0)
      return bad("phone " + phone.label + " has a context that does not exist");
  return {};
}

Result<void> check_phone(const Model& model, const PhoneModel& phone) {
  if (phone.label.empty() || phone.modes.empty())
    return bad("phone '" + phone.label + "' has no label or no mode");
  for (const Mode& mode : phone.modes) {
    if (!(mode.sigma > 0) || !(mode.sigma < 1e3))
      return bad("phone " + phone.label + " has a width out of range");
    if (mode.coefficients.size() != (model.order + 1) * model.controls.size())
      return bad("phone " + phone.label + " has a wrong number of coefficients");
    for (const double a : mode.coefficients)
      if (!std::isfinite(a))
        return bad("phone " + phone.label + " has a coefficient without value");
  }
  return check_contexts(model, phone);
}

}  // namespace

Result<void> validate(const Model& model) {
  if (method_name(model.method).empty()) return bad("its method is unknown");
  if (model.order > 8) return bad("the degree of its polynomials is above 8");
  if (!(model.time_margin >= 0)) return bad("its time margin is negative");
  if (!(model.pause_edge > 0) || !(model.pause_edge <= 5))
    return bad("its pause edge is out of range");
  if (!std::isfinite(model.closure_gap)) return bad("its closure gap is not a number");
  if (!model.rate.valid()) return bad("its frame rate is zero");
  if (model.controls.empty()) return bad("it has no control");
  for (const Control& c : model.controls)
    if (c.name.empty() || !std::isfinite(c.rest) || !std::isfinite(c.mean) ||
        !std::isfinite(c.sd) || c.sd < 0)
      return bad("control '" + c.name + "' has no name or no finite statistics");
  if (model.phones.empty()) return bad("it has no phone");
  for (std::size_t p = 0; p < model.phones.size(); ++p) {
    if (p > 0 && !(model.phones[p - 1].label < model.phones[p].label))
      return bad("its phones are not sorted");
    if (auto ok = check_phone(model, model.phones[p]); !ok) return ok;
  }
  return {};
}

}  // namespace animeme::dam
