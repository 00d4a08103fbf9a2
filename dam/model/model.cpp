#include "dam/model/model.h"

#include <algorithm>
#include <cmath>

#include "dam/model/kind_internal.h"

namespace animeme::dam {

namespace {

/// The first letters as a number that sorts as they do.
std::uint32_t first_letters(std::string_view label) {
  std::uint32_t letters = 0;
  for (std::size_t i = 0; i < 4; ++i)
    letters = letters << 8 | (i < label.size() ? std::uint32_t(std::uint8_t(label[i])) : 0);
  return letters;
}

}  // namespace

std::int32_t Model::find_phone(std::string_view label) const {
  // Speech asks for each phone several times, so labels are compared by their first letters.
  const std::uint32_t letters = first_letters(label);
  const auto at = std::lower_bound(
      phones.begin(), phones.end(), label, [&](const PhoneModel& p, std::string_view l) {
        const std::uint32_t own = first_letters(p.label);
        return own != letters ? own < letters : std::string_view(p.label) < l;
      });
  return at != phones.end() && at->label == label ? std::int32_t(at - phones.begin()) : -1;
}

std::int32_t Model::find_control(std::string_view name) const {
  for (std::size_t c = 0; c < controls.size(); ++c)
    if (controls[c].name == name) return std::int32_t(c);
  return -1;
}

Result<void> validate(const Model& model) {
  if (method_name(model.method).empty()) return invalid_model("its method is unknown");
  if (!(model.pause_edge > 0) || !(model.pause_edge <= 5))
    return invalid_model("its pause edge is out of range");
  if (!std::isfinite(model.closure_gap)) return invalid_model("its closure gap is not a number");
  if (model.lip_tooth_raise && !std::isfinite(*model.lip_tooth_raise))
    return invalid_model("its lip-tooth contact is not a number");
  if (model.closure_duration && !(std::abs(model.closure_duration->base) <= 10 &&
                                  std::abs(model.closure_duration->slope) <= 100))
    return invalid_model("the duration of its closures is out of range");
  if (!(model.articulation >= 0 && model.articulation <= kMostArticulation))
    return invalid_model("its articulation is out of range");
  if (!model.rate.valid()) return invalid_model("its frame rate is zero");
  if (model.controls.empty()) return invalid_model("it has no control");
  for (const Control& c : model.controls)
    if (c.name.empty() || !std::isfinite(c.rest) || !std::isfinite(c.mean) ||
        !std::isfinite(c.sd) || c.sd < 0)
      return invalid_model("control '" + c.name + "' has no name or no finite statistics");
  if (!model.limits.empty() && model.limits.size() != model.controls.size())
    return invalid_model("its limits do not match its controls");
  for (std::size_t c = 0; c < model.limits.size(); ++c) {
    const ControlLimit& limit = model.limits[c];
    const auto other = std::size_t(std::max(0, limit.opposite));
    if (!(limit.low <= limit.high))
      return invalid_model("control '" + model.controls[c].name +
                           "' has no value within its limits");
    if (!(limit.shared >= 0) || !std::isfinite(limit.shared))
      return invalid_model("what control '" + model.controls[c].name + "' shares is no value");
    if (limit.opposite >= 0 && (other >= model.limits.size() || other == c ||
                                model.limits[other].opposite != std::int32_t(c) ||
                                model.limits[other].shared != limit.shared))
      return invalid_model("the opposite of control '" + model.controls[c].name + "' is none");
  }
  if (model.phones.empty()) return invalid_model("it has no phone");
  for (std::size_t p = 0; p < model.phones.size(); ++p) {
    if (p > 0 && !(model.phones[p - 1].label < model.phones[p].label))
      return invalid_model("its phones are not sorted");
    const PhoneModel& phone = model.phones[p];
    if (phone.label.empty()) return invalid_model("a phone has no label");
    if (!(phone.duration > 0) || !(phone.longest > 0) || !std::isfinite(phone.duration) ||
        !std::isfinite(phone.longest))
      return invalid_model("phone " + phone.label + " has no duration");
  }
  return kind_of(model.method).validate(model);
}

}  // namespace animeme::dam
