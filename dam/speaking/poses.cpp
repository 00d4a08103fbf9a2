#include "dam/speaking/poses.h"

#include "dam/script/phones.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

constexpr double kSilenceBeside = 0.5, kHeldFor = 0.3;  // seconds

Result<void> add_phone(const Model& model, const std::string& label, Poses& poses) {
  std::string name = label;
  for (char& c : name)
    if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
  if (find_phone(name) == nullptr)
    return make_error(
        Code::invalid_argument,
        "'" + label + "' is not a phone; poses are \"rest\" or phones as AA, IY, UW, M");
  Script script;
  script.phones = {
      {0, kSilenceBeside, std::string(kSilence), ""},
      {kSilenceBeside, kSilenceBeside + kHeldFor, name, ""},
      {kSilenceBeside + kHeldFor, 2 * kSilenceBeside + kHeldFor, std::string(kSilence), ""}};
  SynthesisOptions options;
  options.rate = {100, 1};
  const auto signal = synthesise(model, script, options);
  if (!signal) return signal.error();
  const auto middle = std::size_t((kSilenceBeside + kHeldFor / 2) * 100 + 0.5);
  for (std::size_t c = 0; c < model.controls.size(); ++c)
    poses.values.push_back(signal->at(middle, c));
  return {};
}

}  // namespace

Result<Poses> poses_of(const Model& model, std::span<const std::string> labels) {
  Poses poses;
  for (const Control& control : model.controls) poses.names.push_back(control.name);
  for (const std::string& label : labels) {
    poses.labels.push_back(label);
    if (is_rest_pose(label)) {
      for (const Control& control : model.controls) poses.values.push_back(control.rest);
    } else if (auto added = add_phone(model, label, poses); !added) {
      return added.error();
    }
  }
  return poses;
}

}  // namespace animeme::dam
