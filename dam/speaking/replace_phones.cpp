#include <algorithm>

#include "dam/script/features.h"
#include "dam/script/phones.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

/// The label itself or the nearest phone that the model has for it; empty: the model has none.
std::string_view known_like(const Model& model, std::string_view label) {
  if (model.find_phone(label) >= 0) return label;
  for (const Relative& relative : phone_relatives(label))
    if (relative.count == 1 && model.find_phone(relative.part[0].label) >= 0)
      return relative.part[0].label;
  return {};
}

/// What the mouth does beside phone `at`: how the next vowel begins, or how the one before ends.
/// Empty: there is none before the next silence.
std::string_view vowel_beside(const Model& model, const Script& script, std::size_t at, bool next) {
  const std::size_t count = script.phones.size();
  for (std::size_t i = next ? at + 1 : at - 1; i < count; i += next ? 1 : std::size_t(-1)) {
    const std::string& label = script.phones[i].label;
    if (label == kSilence) break;
    const PhoneInfo* info = find_phone(label);
    if (info == nullptr || !info->vowel) continue;
    const auto sounds = phone_features(label);
    return known_like(model, nearest_phone(next ? sounds.front() : sounds.back()));
  }
  return {};
}

/// The labels that replace phone `at` in one alternative; empty if the model lacks one.
std::vector<std::string_view> labels_of(const Model& model, const Script& script, std::size_t at,
                                        const Relative& relative) {
  std::vector<std::string_view> labels;
  for (const RelativePart& part : relative.parts()) {
    const bool next = part.label == kNextVowel;
    const std::string_view label =
        next || part.label == kVowelBefore ? vowel_beside(model, script, at, next) : part.label;
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

/// The nearest relative that the model can say. All other phones are relatives: a model of few
/// sounds speaks everything, with the mouth that comes nearest.
Stand stand_in(const Model& model, const Script& script, std::size_t at) {
  for (const Relative& relative : phone_relatives(script.phones[at].label))
    if (auto labels = labels_of(model, script, at, relative); !labels.empty())
      return {&relative, std::move(labels)};
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
      return make_error(Code::not_found, "the model has no replacement for the phone " +
                                             phone.label + " at " + std::to_string(phone.start) +
                                             " s; train with sentences in which somebody speaks");
  }
  return out;
}

}  // namespace animeme::dam
