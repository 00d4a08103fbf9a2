#include "dam/training/adapt.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "dam/corpus/statistics_internal.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/accumulate.h"
#include "dam/training/adapt_internal.h"
#include "dam/training/alignment.h"
#include "dam/training/train.h"
#include "dam/training/train_notes_internal.h"
#include "dam/training/training_sums_internal.h"

namespace animeme::dam {
namespace {

/// With so many sentences the first fold alone is enough.
constexpr std::size_t kManySentences = 100;
/// Factors of the ridges that are tried: what is left of a stranger is held more firmly than what
/// is all.
constexpr double kRidges[] = {1, 4, 20, 100};

using Sentences = std::vector<const Utterance*>;
using Signals = std::vector<const Signal*>;

/// The own sentences, in an order that does not depend on how they were given, spoken by the base.
struct Material {
  std::vector<Utterance> sentences;  ///< with phones of the base
  std::vector<Signal> made;

  std::pair<Sentences, Signals> part(std::size_t fold, std::size_t folds, bool inside) const {
    std::pair<Sentences, Signals> out;
    for (std::size_t s = 0; s < sentences.size(); ++s) {
      if ((folds > 0 && s % folds == fold) != inside) continue;
      out.first.push_back(&sentences[s]);
      out.second.push_back(&made[s]);
    }
    return out;
  }
};

SynthesisOptions as_learned(const Signal& like) {
  SynthesisOptions options;
  options.rate = like.rate;
  options.frames = like.frames();
  options.closure = false;
  options.sharpness = 0;
  options.rest_at_ends = false;
  return options;
}

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

/// Sums over what the base leaves over.
Result<TrainingSums> sums_of_rest(const Model& base, const Sentences& sentences,
                                  const Signals& made, const Telling& telling,
                                  const TrainOptions& options) {
  auto sums = TrainingSums::start(options, &base);
  if (!sums) return sums;
  auto state = std::move(*sums).release();
  for (std::size_t s = 0; s < sentences.size(); ++s) {
    Utterance rest{sentences[s]->id, "", sentences[s]->script, {}, {}};
    rest.signal = rest_of(sentences[s]->signal, *made[s], telling);
    if (auto added = add_to_sums(*state, rest, sentence_digest(rest)); !added) return added.error();
  }
  return TrainingSums(std::move(state));
}

Result<Model> solved(const TrainingSums& sums, TrainOptions options, double ridge) {
  options.method = Method::dam;
  options.refined.ridge = ridge;
  return train_from_sums(TrainingSums(std::make_unique<SumsState>(sums.state())), options);
}

/// Squared error as a share of the variance in `scale`, mean over the controls that move; what a
/// sentence is off as a whole does not count.
double error_of(const Model& model, const Sentences& sentences, std::span<const Control> scale) {
  const std::size_t k = model.controls.size();
  std::vector<double> error(k, 0.0);
  double frames = 0;
  for (const Utterance* u : sentences) {
    const auto made = synthesise(model, u->script, as_learned(u->signal));
    const auto speech = speech_frames(*u);
    std::vector<double> sum(k, 0.0), squares(k, 0.0);
    double count = 0;
    for (std::size_t i = 0; made && i < speech.size(); ++i) {
      if (!speech[i]) continue;
      count += 1;
      for (std::size_t c = 0; c < k; ++c) {
        const double d = u->signal.at(i, c) - made->at(i, c);
        sum[c] += d;
        squares[c] += d * d;
      }
    }
    frames += count;
    for (std::size_t c = 0; c < k; ++c)
      error[c] += squares[c] - sum[c] * sum[c] / std::max(1.0, count);
  }
  double total = 0, moving = 0;
  for (std::size_t c = 0; c < k; ++c) {
    if (scale[c].sd == 0) continue;
    moving += 1;
    total += error[c] / (std::max(1.0, frames) * scale[c].sd * scale[c].sd);
  }
  return moving > 0 ? total / moving : 0;
}

Result<Model> own_alone(const Sentences& sentences, TrainOptions options) {
  options.method = Method::dam;
  options.refined.ridge = 0;
  std::vector<Utterance> copies;
  for (const Utterance* u : sentences) copies.push_back(*u);
  return train(copies, options);
}

/// Chooses by sentences that are left out in turn; 0: the base alone.
Result<double> choose(const Model& base, const Material& material,
                      const std::vector<Control>& controls, const TrainOptions& options,
                      AdaptReport& report, const ProgressFunction& progress) {
  const std::span<const double> ridges =
      options.refined.ridge > 0 ? std::span(&options.refined.ridge, 1) : std::span(kRidges);
  const std::size_t folds = std::min(kFolds, material.sentences.size());
  if (folds < 2) return ridges.back();
  const std::size_t tried = material.sentences.size() >= kManySentences ? 1 : folds;
  double alone = 0;
  std::vector<double> error(ridges.size(), 0.0);
  for (std::size_t fold = 0; fold < tried; ++fold) {
    const auto [in, in_made] = material.part(fold, folds, false);
    const auto out = material.part(fold, folds, true).first;
    const Telling telling = tell_base(base, in, in_made);
    alone += error_of(add_up(base, telling, controls, nullptr), out, controls) / double(tried);
    const auto own = own_alone(in, options);
    if (!own) return own.error();
    report.own_error += error_of(*own, out, controls) / double(tried);
    const auto sums = sums_of_rest(base, in, in_made, telling, options);
    if (!sums) return sums.error();
    for (std::size_t r = 0; r < ridges.size(); ++r) {
      const double done = (double(fold) + double(r) / double(ridges.size())) / double(tried);
      if (progress && !progress({"base", done, 0}))
        return make_error(Code::invalid_argument, "cancelled");
      const auto more = solved(*sums, options, ridges[r]);
      if (!more) return more.error();
      error[r] += error_of(add_up(base, telling, controls, &*more), out, controls) / double(tried);
    }
  }
  const auto best = std::min_element(error.begin(), error.end());
  report.base_error = alone;
  report.error = std::min(alone, *best);
  return *best < alone ? ridges[std::size_t(best - error.begin())] : 0;
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
  const CleanedSentences mended = remove_glitches(sorted_sentences(sentences));
  const auto material = material_of(base, mended.sentences);
  if (!material) return material.error();
  out.glitches = mended.glitches;
  const auto [all, made] = material->part(0, 0, false);
  const std::vector<Control> controls = control_statistics(all, base.pause_edge);
  const Telling telling = tell_base(base, all, made, &out.controls);
  out.sentences = all.size();
  for (const Utterance* u : all) {
    const auto speech = speech_frames(*u);
    out.seconds += u->signal.rate.seconds(double(std::count(speech.begin(), speech.end(), true)));
  }
  const auto ridge = choose(base, *material, controls, options, out, progress);
  if (!ridge) return ridge.error();
  out.ridge = options.refined.ridge > 0 ? options.refined.ridge : *ridge;
  if (report != nullptr) {
    auto alignment = check_alignment(all, options.threads);
    if (alignment) out.alignment = std::move(*alignment);
    out.warnings = warnings_of(out.alignment, out.glitches);
  }
  std::optional<Model> more;
  if (out.ridge > 0) {
    const auto sums = sums_of_rest(base, all, made, telling, options);
    if (!sums) return sums.error();
    auto solution = solved(*sums, options, out.ridge);
    if (!solution) return solution.error();
    more = std::move(*solution);
  }
  Model model = add_up(base, telling, controls, more ? &*more : nullptr);
  settle_controls(model.controls);
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
