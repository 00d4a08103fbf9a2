#include "dam/training/train_notes_internal.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dam/script/phones.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kFewExamples = 12;
constexpr double kLittleSpeech = 60;  // seconds
constexpr std::size_t kNamedDoubts = 10, kNamedGlitches = 8;

std::string joined(const std::vector<std::string>& items, const char* between) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : between) + item;
  return text;
}

/// Adds "start item, item" if there are items.
void warn_of(const char* start, const std::vector<std::string>& items, const char* between,
             TrainSummary& summary) {
  if (!items.empty()) summary.warnings.push_back(start + joined(items, between));
}

std::string spoken_instead(const Model& model, std::string_view label) {
  const auto relatives = phone_relatives(label);
  const std::string_view first = relatives.empty() ? "" : relatives[0].part[0].label;
  if (first == kNextVowel) return "the next vowel";
  if (first == kVowelBefore) return "the vowel before";
  Script script;
  script.phones = {{0, 1, std::string(label), ""}};
  SynthesisReport report;
  if (!replace_unknown_phones(model, script, &report) || report.replaced.empty()) return {};
  return report.replaced[0].second;
}

std::vector<std::string> classmates(const Model& model, const PhoneModel& phone) {
  std::vector<std::string> labels;
  for (const PhoneModel& other : model.phones)
    if (other.context_class == phone.context_class && other.label != phone.label)
      labels.push_back(other.label);
  return labels;
}

void warn_of_controls(TrainSummary& summary) {
  std::vector<std::string> noise;
  for (const ControlNote& control : summary.controls) {
    if (control.constant)
      summary.warnings.push_back("control '" + control.name +
                                 "' never moves and is kept as a constant");
    else if (control.explained < kNoise)
      noise.push_back(control.name);
  }
  warn_of(
      "controls that do not follow the phones (under 2 % of the motion explained), so they "
      "may be noise: ",
      noise, ", ", summary);
}

void warn_of_phones(TrainSummary& summary) {
  std::vector<std::string> few, silent;
  for (const RarePhone& phone : summary.rare)
    few.push_back(
        phone.label + " " + std::to_string(phone.examples) +
        (phone.leans_on.empty() ? "" : " (leans on " + joined(phone.leans_on, " ") + ")"));
  warn_of("phones with few examples, whose shapes are uncertain: ", few, ", ", summary);
  for (const UnknownPhone& phone : summary.unknown)
    if (phone.spoken_as.empty()) silent.push_back(phone.label);
  warn_of("phones without a replacement in the data, so scripts with them are refused: ", silent,
          " ", summary);
}

void warn_of_sentences(TrainSummary& summary) {
  std::vector<std::string> standing;
  for (const SentenceNote& s : summary.outliers) {
    char text[120];
    if (s.offset > kOutlierOffset)
      std::snprintf(text, sizeof text, " (off as a whole, %.1f times the usual)", s.offset);
    else
      std::snprintf(text, sizeof text, " (its error is %.1f times the median)", s.error);
    standing.push_back(s.id + text);
  }
  warn_of("outlier sentences; check their labels and curves: ", standing, ", ", summary);
}

void warn_of_amount(TrainSummary& summary) {
  if (summary.speech_seconds == 0 || summary.speech_seconds >= kLittleSpeech) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "%.0f s of speech are too little to learn all sounds: adapt an existing model "
                "(--base builtin), or record more; two minutes are a start",
                summary.speech_seconds);
  summary.warnings.emplace_back(text);
}

std::string milliseconds(double seconds) {
  return std::to_string(std::lround(std::abs(seconds) * 1000)) + " ms";
}

std::string lag_warning(const LagEstimate& lag) {
  char text[240];
  std::snprintf(
      text, sizeof text,
      "the motion comes %s %s the sound (95 %%: %+.0f to %+.0f ms); --lag auto shifts the "
      "scripts, or --lag with a number of ms",
      milliseconds(lag.seconds).c_str(), lag.seconds > 0 ? "after" : "before", 1000 * lag.low,
      1000 * lag.high);
  return text;
}

std::string doubts_warning(const Alignment& alignment) {
  std::vector<std::string> named;
  for (const ScriptDoubt& one : alignment.doubts) {
    if (named.size() == kNamedDoubts) break;
    named.push_back(one.id + (!one.shift ? " (another text?)"
                                         : " (" + milliseconds(*one.shift) +
                                               (*one.shift > 0 ? " late?)" : " early?)")));
  }
  const std::size_t count = alignment.doubts.size();
  return std::to_string(count) + (count == 1 ? " sentence does" : " sentences do") +
         " not move as the script says; look at text and times of: " + joined(named, ", ") +
         (count > named.size() ? " ..." : "");
}

}  // namespace

std::vector<const Utterance*> sorted_sentences(std::span<const Utterance> utterances) {
  std::vector<const Utterance*> list;
  for (const Utterance& u : utterances) list.push_back(&u);
  std::stable_sort(list.begin(), list.end(),
                   [](const Utterance* a, const Utterance* b) { return a->id < b->id; });
  return list;
}

std::vector<std::string> warnings_of(const Alignment& alignment, std::span<const Glitch> glitches) {
  std::vector<std::string> warnings;
  for (const Glitch& glitch : glitches.first(std::min(glitches.size(), kNamedGlitches)))
    warnings.push_back(describe(glitch));
  if (glitches.size() > kNamedGlitches)
    warnings.push_back("... and " + std::to_string(glitches.size() - kNamedGlitches) +
                       " more tracking glitches (--json lists them all)");
  if (alignment.unrelated)
    warnings.emplace_back(
        "the scripts do not seem to match the motion: those of other sentences fit equally well; "
        "check ids, texts and where each recording begins");
  if (alignment.lag && alignment.lag->notable()) warnings.push_back(lag_warning(*alignment.lag));
  if (!alignment.doubts.empty()) warnings.push_back(doubts_warning(alignment));
  return warnings;
}

void note_phones(const Model& model, TrainSummary& summary) {
  for (const PhoneModel& phone : model.phones) {
    if (phone.examples >= kFewExamples) continue;
    summary.rare.push_back({phone.label, phone.examples, {}});
    if (model.method == Method::dam) summary.rare.back().leans_on = classmates(model, phone);
  }
  for (const PhoneInfo& info : phones())
    if (info.label != kSilence && model.find_phone(info.label) < 0)
      summary.unknown.push_back({std::string(info.label), spoken_instead(model, info.label)});
}

void add_warnings(TrainSummary& summary) {
  warn_of_controls(summary);
  warn_of_phones(summary);
  warn_of_sentences(summary);
  for (std::string& text : warnings_of(summary.alignment, summary.glitches))
    summary.warnings.push_back(std::move(text));
  warn_of_amount(summary);
}

}  // namespace animeme::dam
