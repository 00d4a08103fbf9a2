#include "tools/commands/train_report.h"

#include <algorithm>
#include <cstdio>

#include "tools/commands/common.h"
#include "tools/json.h"

namespace animeme::tools {

namespace {

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[240];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

// The part of the objective by which a step lowered it.
double relative_fall(const std::vector<double>& objective, std::size_t step) {
  const double before = objective[step - 1];
  return before != 0 ? (before - objective[step]) / std::abs(before) : 0;
}

Json steps_json(const dam::TrainSummary& summary) {
  Json steps = Json::array();
  for (std::size_t i = 1; i < summary.objective.size(); ++i) {
    steps.push_back({{"objective", summary.objective[i]},
                     {"relative_fall", relative_fall(summary.objective, i)}});
  }
  return steps;
}

Json phones_json(const dam::TrainSummary& summary, Json& unknown) {
  Json rare = Json::array();
  for (const dam::RarePhone& phone : summary.rare) {
    rare.push_back(
        {{"phone", phone.label}, {"examples", phone.examples}, {"leans_on", phone.leans_on}});
  }
  unknown = Json::array();
  for (const dam::UnknownPhone& phone : summary.unknown) {
    unknown.push_back({{"phone", phone.label}, {"spoken_as", phone.spoken_as}});
  }
  return rare;
}

void say_steps(const dam::TrainSummary& summary) {
  if (summary.objective.empty()) return;
  say(text("start: objective %.1f", summary.objective[0]));
  for (std::size_t i = 1; i < summary.objective.size(); ++i) {
    say(text("step %zu: objective %.1f, %.3g %% less", i, summary.objective[i],
             100 * relative_fall(summary.objective, i)));
  }
  say(summary.converged ? text("converged after %d steps", summary.iterations)
                        : text("stopped after %d steps, before convergence; --max-iterations "
                               "allows more",
                               summary.iterations));
}

void say_explained(const dam::TrainSummary& summary) {
  double sum = 0;
  std::size_t moving = 0;
  const dam::ControlNote* least = nullptr;
  for (const dam::ControlNote& control : summary.controls) {
    if (control.constant) continue;
    sum += control.explained;
    ++moving;
    if (least == nullptr || control.explained < least->explained) least = &control;
  }
  if (least == nullptr) return;
  say(text("%.0f %% of the motion explained (%s sentences), least of %s: %.0f %%",
           100 * sum / double(moving), summary.held_out ? "held-out" : "training",
           least->name.c_str(), 100 * least->explained));
}

}  // namespace

Json train_json(const std::string& output, const dam::Model& model,
                const dam::TrainSummary& summary) {
  Json json = {{"model", output},
               {"method", dam::method_name(model.method)},
               {"utterances", summary.utterances},
               {"frames", summary.frames},
               {"phone_occurrences", summary.occurrences},
               {"phones", model.phones.size()},
               {"modes", summary.modes},
               {"controls", model.controls.size()}};
  if (!summary.objective.empty()) {
    json["iterations"] = summary.iterations;
    json["converged"] = summary.converged;
    json["objective"] = summary.objective;
    json["steps"] = steps_json(summary);
    json["lag_seconds"] = summary.lag;
  }
  if (summary.ridge > 0) json["ridge_factor"] = summary.ridge;
  json["explained_on"] = summary.held_out ? "held_out" : "training";
  Json explained = Json::array();
  for (const dam::ControlNote& control : summary.controls) {
    explained.push_back({{"control", control.name},
                         {"constant", control.constant},
                         {"explained", control.explained}});
  }
  json["explained"] = std::move(explained);
  Json unknown;
  json["rare_phones"] = phones_json(summary, unknown);
  json["unknown_phones"] = std::move(unknown);
  json["standing_out"] = Json::array();
  for (const dam::SentenceNote& s : summary.standing) {
    json["standing_out"].push_back({{"id", s.id}, {"offset", s.offset}, {"error", s.error}});
  }
  json["training_seconds"] = summary.seconds;
  json["warnings"] = summary.warnings;
  return json;
}

void say_training(const std::string& output, const dam::Model& model,
                  const dam::TrainSummary& summary, double seconds) {
  say(text("%zu utterances, ", summary.utterances) +
      (seconds > 0 ? text("%.1f s, ", seconds) : std::string()) +
      text("%zu phones (%zu occurrences), %zu controls", model.phones.size(), summary.occurrences,
           model.controls.size()) +
      (summary.modes == 0 ? std::string() : text(", %zu modes", summary.modes)));
  say_steps(summary);
  if (summary.ridge > 0) say(text("ridges times %g", summary.ridge));
  say_explained(summary);
  std::string unknown;
  for (const dam::UnknownPhone& phone : summary.unknown) {
    if (!phone.spoken_as.empty()) unknown += " " + phone.label + " (" + phone.spoken_as + ")";
  }
  if (!unknown.empty()) say("not in the data, spoken by relatives:" + unknown);
  say(output + text(": trained in %.1f s", summary.seconds));
}

}  // namespace animeme::tools
