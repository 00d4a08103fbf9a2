#include "tools/formats/inspect/training.h"

#include <cmath>

#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/inspect/left_out.h"

namespace animeme::inspect {

using tools::format;

namespace {

using tools::Json;
using tools::json_list;

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

std::string steps_text(const dam::TrainSummary& summary) {
  if (summary.objective.empty()) return {};
  std::string text = format("start: objective %.1f\n", summary.objective[0]);
  for (std::size_t i = 1; i < summary.objective.size(); ++i) {
    text += format("step %zu: objective %.1f, %.3g %% less\n", i, summary.objective[i],
                   100 * relative_fall(summary.objective, i));
  }
  if (summary.converged) return text + format("converged after %d steps\n", summary.iterations);
  return text +
         format("stopped after %d steps, before convergence; allow more with --max-iterations\n",
                summary.iterations);
}

std::string lag_text(const dam::Alignment& alignment) {
  if (!alignment.lag || alignment.lag->notable()) return {};  // that one is a warning
  return format("sound and motion are synchronous (%+.0f ms, 95 %%: %+.0f to %+.0f ms)\n",
                1000 * alignment.lag->seconds, 1000 * alignment.lag->low,
                1000 * alignment.lag->high);
}

std::string explained_text(const dam::TrainSummary& summary) {
  if (!summary.held_out) return "too few sentences to estimate the explained variance\n";
  double sum = 0;
  std::size_t moving = 0;
  const dam::ControlNote* least = nullptr;
  for (const dam::ControlNote& control : summary.controls) {
    if (control.constant) continue;
    sum += control.explained;
    ++moving;
    if (least == nullptr || control.explained < least->explained) least = &control;
  }
  if (least == nullptr) return {};
  return format("%.0f %% of the variance of held-out sentences explained, lowest for %s: %.0f %%\n",
                100 * sum / double(moving), least->name.c_str(), 100 * least->explained);
}

}  // namespace

std::string alignment_json(const dam::Alignment& alignment) {
  Json json = {{"sentences", alignment.sentences},
               {"fit", alignment.fit},
               {"fit_of_other_scripts", alignment.chance},
               {"unrelated", alignment.unrelated}};
  json["lag_ms"] = nullptr;
  if (alignment.lag) {
    json["lag_ms"] = 1000 * alignment.lag->seconds;
    json["lag_low_ms"] = 1000 * alignment.lag->low;
    json["lag_high_ms"] = 1000 * alignment.lag->high;
  }
  json["doubts"] = json_list(alignment.doubts, [](const dam::ScriptDoubt& one) {
    Json doubt = {{"id", one.id}, {"fit", one.fit}, {"usual", one.usual}};
    doubt["shift_ms"] = one.shift ? Json(1000 * *one.shift) : Json(nullptr);
    return doubt;
  });
  return json.dump();
}

std::string training_json(const std::string& output, const dam::Model& model,
                          const dam::TrainSummary& summary, const TrainingData& data) {
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
  }
  if (summary.ridge > 0) json["ridge_factor"] = summary.ridge;
  json["explained_on"] = summary.held_out ? "held_out" : "training";
  json["explained"] = json_list(summary.controls, [](const dam::ControlNote& one) {
    return Json{{"control", one.name}, {"constant", one.constant}, {"explained", one.explained}};
  });
  json["rare_phones"] = json_list(summary.rare, [](const dam::RarePhone& one) {
    return Json{{"phone", one.label}, {"examples", one.examples}, {"leans_on", one.leans_on}};
  });
  json["unknown_phones"] = json_list(summary.unknown, [](const dam::UnknownPhone& one) {
    return Json{{"phone", one.label}, {"spoken_as", one.spoken_as}};
  });
  json["outliers"] = json_list(summary.outliers, [](const dam::SentenceNote& one) {
    return Json{{"id", one.id}, {"offset", one.offset}, {"error", one.error}};
  });
  json["glitches"] = *Json::parse(glitches_json(summary.glitches));
  json["alignment"] = *Json::parse(alignment_json(summary.alignment));
  json["speech_seconds"] = summary.speech_seconds;
  json["training_seconds"] = summary.seconds;
  json["warnings"] = summary.warnings;
  if (data.parts.empty()) {
    json["corpus_seconds"] = data.seconds;
    json["blanks"] = *Json::parse(blanks_json(data.left_out));
  } else {
    json["parts"] = data.parts;
  }
  return tools::pretty(json);
}

std::string training_text(const std::string& output, const dam::Model& model,
                          const dam::TrainSummary& summary, const TrainingData& data) {
  std::string text = format("%zu utterances, ", summary.utterances);
  if (data.seconds > 0) text += format("%.1f s, ", data.seconds);
  text += format("%zu phones (%zu occurrences), %zu controls", model.phones.size(),
                 summary.occurrences, model.controls.size());
  if (summary.modes > 0) text += format(", %zu modes", summary.modes);
  text += "\n" + steps_text(summary);
  if (summary.ridge > 0) text += format("ridge factor %g\n", summary.ridge);
  text += explained_text(summary) + lag_text(summary.alignment);
  return text + output + format(": trained in %.1f s", summary.seconds);
}

std::string ties_text(const dam::TrainSummary& summary) {
  std::string ties;
  for (const dam::UnknownPhone& phone : summary.unknown) {
    if (!phone.spoken_as.empty()) ties += " " + phone.label + " (" + phone.spoken_as + ")";
  }
  return ties.empty() ? ties : "not in the data, replaced by similar phones:" + ties;
}

}  // namespace animeme::inspect
