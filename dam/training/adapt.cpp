#include "dam/training/adapt.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "dam/corpus/statistics_internal.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/adapt_internal.h"
#include "dam/training/alignment.h"
#include "dam/training/train_notes_internal.h"

namespace animeme::dam {
namespace {

/// Factors of the ridges that are tried.
constexpr double kRidges[] = {1, 4, 20};
/// Errors above this share of a still face's are reported.
constexpr double kHardlyBetter = 0.98;

Result<void> check(const Utterance& u, const Utterance& first) {
  const auto bad = [&](const char* what) {
    return make_error(Code::invalid_argument, "sentence '" + u.id + "' " + what);
  };
  if (u.signal.names.empty() || u.signal.names != first.signal.names)
    return bad("has other controls than the first");
  for (const double value : u.signal.values)
    if (!std::isfinite(value)) return bad("has a value that is not finite");
  if (auto ok = check_script(u.script); !ok) return bad("has a broken script");
  return {};
}

Result<Material> material_of(const Model& base, std::span<const Utterance* const> sentences) {
  Material material;
  for (const Utterance* u : sentences) material.sentences.push_back(*u);
  for (Utterance& u : material.sentences) {
    if (auto ok = check(u, material.sentences[0]); !ok) return ok.error();
    auto script = replace_unknown_phones(base, u.script);
    if (!script) return script.error();
    u.script = std::move(*script);
    auto made = synthesise(base, u.script, as_learned(u.signal));
    if (!made) return made.error();
    material.made.push_back(std::move(*made));
  }
  return material;
}

/// The better of the base and of own curves is kept, so what remains to be said is that.
void warn_of_little_use(AdaptReport& report) {
  if (report.error.nrmse == 0) return;
  char text[240];
  if (report.base_share == 0) {
    std::snprintf(text, sizeof text,
                  "the base does not help on held-out sentences (NRMSE %.3f with it, %.3f without "
                  "it), so the model is of these sentences alone",
                  report.base_error.nrmse, report.own_error.nrmse);
    report.warnings.emplace_back(text);
  }
  if (report.error.nrmse >= kHardlyBetter * report.still_error.nrmse) {
    std::snprintf(
        text, sizeof text,
        "on held-out sentences the model is hardly better than a still face (NRMSE %.3f and "
        "%.3f): check the scripts and the tracker, or record more",
        report.error.nrmse, report.still_error.nrmse);
    report.warnings.emplace_back(text);
  }
}

std::string joined(const std::string& first, const std::string& second) {
  return first.empty() || second.empty() ? first + second : first + "; " + second;
}

}  // namespace

Result<Model> adapt(const Model& wanted_base, std::span<const Utterance> sentences,
                    const TrainOptions& options, AdaptReport* report,
                    const ProgressFunction& progress) {
  if (auto ok = validate(options); !ok) return ok.error();
  if (sentences.empty())
    return make_error(Code::invalid_argument, "there is no sentence to adapt to");
  if (!std::holds_alternative<RefinedParameters>(wanted_base.parameters))
    return make_error(Code::invalid_argument,
                      "a base must be a model of the method dam, this one is of " +
                          std::string(method_name(wanted_base.method)));
  AdaptReport own;
  AdaptReport& out = report != nullptr ? *report : own;
  out = {};
  Model base = wanted_base;
  base.limits.clear();  // they are of its own face
  base = with_levels(base);
  const CleanedSentences mended = remove_glitches(sorted_sentences(sentences));
  const auto material = material_of(base, mended.sentences);
  if (!material) return material.error();
  out.glitches = mended.glitches;
  const auto [all, made] = material->part(0, 0, false);
  const std::vector<Control> controls = control_statistics(all, base.pause_edge);
  const Telling telling = tell_base(base, controls, all, made, &out.controls);
  out.sentences = all.size();
  for (const Utterance* u : all) {
    const auto speech = speech_frames(*u);
    out.seconds += u->signal.rate.seconds(double(std::count(speech.begin(), speech.end(), true)));
  }
  Ingredients from{base, *material, controls, {std::begin(kRidges), std::end(kRidges)}, {}};
  if (options.refined.ridge > 0) from.ridges = {options.refined.ridge};
  auto folds = sums_of_folds(base, *material, std::min(kFolds, all.size()), options);
  if (!folds) return folds.error();
  from.folds = std::move(*folds);
  const auto recipe = choose_recipe(from, options, out, progress);
  if (!recipe) return recipe.error();
  out.ridge = recipe->bent_ridge;
  out.own_ridge = recipe->own_ridge;
  out.base_share = std::accumulate(recipe->share.begin(), recipe->share.end(), 0.0) /
                   double(recipe->share.size());
  if (report != nullptr) {
    auto alignment = check_alignment(all, options.threads);
    if (alignment) out.alignment = std::move(*alignment);
    out.warnings = warnings_of(out.alignment, out.glitches);
    warn_of_little_use(out);
  }
  auto mixed = mixed_model(from, *recipe, telling, options);
  if (!mixed) return mixed.error();
  Model model = std::move(*mixed);
  model.articulation = 0;  // whoever records a person wants to see that person
  model.rate = all[0]->signal.rate;
  model.limits = control_limits(all, model.controls);
  model.closure_gap = measured_closure_gap(all);
  if (const auto raise = measured_lip_tooth_raise(all)) model.lip_tooth_raise = raise;
  if (const auto shut = measured_closure_duration(all)) model.closure_duration = shut;
  model.attribution = joined(base.attribution, options.attribution);
  model.provenance = joined(options.provenance, "base: " + base.provenance);
  if (auto ok = validate(model); !ok)
    return make_error(Code::invalid_argument,
                      "the sentences do not fit the base: " + ok.error().message);
  return model;
}

}  // namespace animeme::dam
