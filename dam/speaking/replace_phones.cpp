#include <algorithm>

#include "dam/script/phones.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

/// The vowel after phone `at`, before the next silence, that the model knows; empty if none.
std::string_view next_vowel(const Model& model, const Script& script, std::size_t at) {
  for (std::size_t i = at + 1; i < script.phones.size(); ++i) {
    const std::string& label = script.phones[i].label;
    if (label == kSilence) break;
    const PhoneInfo* info = find_phone(label);
    if (info != nullptr && info->vowel)
      return model.find_phone(label) >= 0 ? label : std::string_view{};
  }
  return {};
}

/// Labels that stand for phone `at` under one alternative; empty if the model lacks one.
std::vector<std::string_view> labels_of(const Model& model, const Script& script, std::size_t at,
                                        const Relative& relative) {
  std::vector<std::string_view> labels;
  for (const RelativePart& part : relative.parts()) {
    const std::string_view label =
        part.label == kNextVowel ? next_vowel(model, script, at) : part.label;
    if (label.empty() || model.find_phone(label) < 0) return {};
    labels.push_back(label);
  }
  return labels;
}

void note(SynthesisReport* report, const std::string& label, const std::string& by) {
  if (report == nullptr) return;
  ++report->replaced_phones;
  const std::pair<std::string, std::string> entry{label, by};
  if (std::find(report->replaced.begin(), report->replaced.end(), entry) == report->replaced.end())
    report->replaced.push_back(entry);
}

/// A relative with its labels.
struct Stand {
  const Relative* relative = nullptr;  ///< nothing: the model has no phone
  std::vector<std::string_view> labels;
};

/// The nearest relative that the model can say; if it has none, one of the relatives' relatives,
/// and so on: a model of few sounds speaks everything, with the mouth that comes nearest.
Stand stand_in(const Model& model, const Script& script, std::size_t at) {
  std::vector<std::string_view> asked = {script.phones[at].label};
  for (std::size_t i = 0; i < asked.size(); ++i) {
    for (const Relative& relative : phone_relatives(asked[i]))
      if (auto labels = labels_of(model, script, at, relative); !labels.empty())
        return {&relative, std::move(labels)};
    for (const Relative& relative : phone_relatives(asked[i]))
      for (const RelativePart& part : relative.parts())
        if (part.label != kNextVowel &&
            std::find(asked.begin(), asked.end(), part.label) == asked.end())
          asked.push_back(part.label);
  }
  return {};
}

bool replace(const Model& model, const Script& script, std::size_t at, Script& out,
             SynthesisReport* report) {
  const Phone& phone = script.phones[at];
  const auto [relative, labels] = stand_in(model, script, at);
  if (relative == nullptr) return false;
  std::string names;
  double start = phone.start;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const bool last = i + 1 == labels.size();
    const double end = last ? phone.end : start + phone.duration() * relative->parts()[i].share;
    out.phones.push_back({start, end, std::string(labels[i]), phone.word});
    names += (i == 0 ? "" : " ") + std::string(labels[i]);
    start = end;
  }
  note(report, phone.label, names);
  return true;
}

}  // namespace

Result<Script> replace_unknown_phones(const Model& model, const Script& script,
                                      SynthesisReport* report) {
  Script out;
  for (std::size_t i = 0; i < script.phones.size(); ++i) {
    const Phone& phone = script.phones[i];
    if (phone.label == kSilence || model.find_phone(phone.label) >= 0)
      out.phones.push_back(phone);
    else if (!replace(model, script, i, out, report))
      return make_error(Code::not_found, "the model has no sound that could stand for the phone " +
                                             phone.label + " at " + std::to_string(phone.start) +
                                             " s; train with sentences in which somebody speaks");
  }
  return out;
}

}  // namespace animeme::dam
