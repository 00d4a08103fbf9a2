#include "dam/evaluation/evaluate.h"

#include <functional>
#include <optional>

#include "dam/corpus/statistics_internal.h"
#include "dam/evaluation/evaluate_series_internal.h"
#include "dam/maths/parallel.h"

namespace animeme::dam {
namespace {

constexpr double kPauseEdge = 0.3;  // seconds; only the rest pose depends on it, which is not used

/// With an empty scale, that of the recordings.
Result<std::vector<Control>> scale_of(std::span<const SentencePair> pairs,
                                      const ScoreOptions& options) {
  if (!options.scale.empty()) return options.scale;
  std::vector<const Utterance*> recordings;
  for (const SentencePair& pair : pairs) {
    recordings.push_back(&pair.recorded);
    if (pair.recorded.signal.names != pairs[0].recorded.signal.names)
      return make_error(Code::not_found, "the recording of sentence '" + pair.recorded.id +
                                             "' has other controls than that of '" +
                                             pairs[0].recorded.id + "'; name a scale");
  }
  return recording_scale(recordings);
}

Result<AllSeries> make_all(std::span<const SentencePair> pairs, const Layout& layout, int threads) {
  std::vector<std::optional<Result<PairSeries>>> made(pairs.size());
  parallel_for(pairs.size(), threads,
               [&](std::size_t i) { made[i].emplace(make_series(pairs[i], layout)); });
  AllSeries all;
  for (auto& one : made) {
    if (!*one) return one->error();
    if (!((*one)->signal().rate == pairs[0].recorded.signal.rate))
      return make_error(Code::invalid_argument,
                        "sentence '" + (*one)->pair->recorded.id +
                            "' has another frame rate than the first one; resample it");
    all.push_back(std::move(**one));
  }
  return all;
}

}  // namespace

std::vector<Control> recording_scale(std::span<const Utterance* const> recordings) {
  if (recordings.empty()) return {};
  return control_statistics(recordings, kPauseEdge);
}

Result<Evaluation> score(std::span<const SentencePair> pairs, const ScoreOptions& options) {
  if (pairs.empty()) return make_error(Code::invalid_argument, "there is no sentence to evaluate");
  auto scale = scale_of(pairs, options);
  if (!scale) return scale.error();
  const Layout layout = make_layout(std::move(*scale));
  auto all = make_all(pairs, layout, options.threads);
  if (!all) return all.error();
  Evaluation result;
  result.utterances = pairs.size();
  score_regions(layout, *all, result);
  if (result.frames == 0)
    return make_error(Code::invalid_argument, "there is no measured frame of speech to score");
  // Each writes to its own members of the result.
  const std::function<void()> analyses[] = {
      [&] { score_closures(layout, *all, options, result); },
      [&] { score_lips(layout, *all, options, result); },
      [&] { score_timing(layout, *all, result); },
      [&] { score_misalignment(layout, *all, result); },
      [&] { score_dynamics(layout, *all, result); },
      [&] { score_breakdown(layout, *all, options.seen, result); }};
  parallel_for(std::size(analyses), options.threads, [&](std::size_t i) { analyses[i](); });
  return result;
}

Result<std::vector<SentencePair>> synthesise_pairs(const Model& model,
                                                   std::span<const Utterance> utterances,
                                                   const EvaluateOptions& options) {
  std::vector<std::optional<Result<Signal>>> made(utterances.size());
  parallel_for(utterances.size(), options.score.threads, [&](std::size_t i) {
    SynthesisOptions synthesis = options.synthesis;
    synthesis.rate = utterances[i].signal.rate;
    synthesis.frames = utterances[i].signal.frames();
    made[i].emplace(synthesise(model, utterances[i].script, synthesis));
  });
  std::vector<SentencePair> pairs;
  for (std::size_t i = 0; i < utterances.size(); ++i) {
    if (!*made[i])
      return make_error(made[i]->error().code,
                        "sentence '" + utterances[i].id + "': " + made[i]->error().message);
    pairs.push_back({utterances[i], std::move(**made[i])});
  }
  return pairs;
}

Result<Evaluation> evaluate(const Model& model, std::span<const Utterance> utterances,
                            const EvaluateOptions& options) {
  const auto pairs = synthesise_pairs(model, utterances, options);
  if (!pairs) return pairs.error();
  ScoreOptions scoring = options.score;
  if (scoring.scale.empty()) scoring.scale = model.controls;
  return score(*pairs, scoring);
}

}  // namespace animeme::dam
