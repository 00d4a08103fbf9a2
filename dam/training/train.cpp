#include "dam/training/train.h"

#include <algorithm>
#include <chrono>

#include "dam/corpus/glitches.h"
#include "dam/corpus/statistics_internal.h"
#include "dam/corpus/training_set_internal.h"
#include "dam/model/kind_internal.h"
#include "dam/training/alignment.h"
#include "dam/training/train_notes_internal.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kEnoughForOneFold = 16;  // sentences; method dam holds some out by itself

void summarise(const TrainingSet& set, std::span<const Utterance* const> sentences,
               TrainSummary& summary) {
  summary.iterations = std::max(0, int(summary.objective.size()) - 1);
  summary.utterances = set.data.sentences.size();
  summary.frames = std::size_t(std::count(set.data.use.begin(), set.data.use.end(), 1));
  summary.occurrences = set.data.occurrences.size();
  for (const Utterance* u : sentences) {
    const auto speech = speech_frames(*u);
    summary.speech_seconds +=
        set.rate.seconds(double(std::count(speech.begin(), speech.end(), true)));
  }
}

/// What is fitted and what came out.
struct Fitted {
  TrainingSet set;
  Model model;
};

Result<Fitted> fit(std::span<const Utterance* const> sentences, const TrainOptions& options,
                   TrainRun& run) {
  auto set = make_training_set(sentences, options);
  if (!set) return set.error();
  Model model;
  model.method = options.method;
  model.pause_edge = options.pause_edge;
  model.closure_gap = set->closure_gap;
  model.lip_tooth_raise = set->lip_tooth_raise;
  model.closure_duration = set->closure_duration;
  model.rate = set->rate;
  model.attribution = options.attribution;
  model.provenance = options.provenance;
  model.controls = set->controls;
  model.limits = control_limits(sentences, model.controls);
  model.phones = set->phones;
  auto parameters = kind_of(options.method).fit(*set, model, options, run);
  if (!parameters) return parameters.error();
  model.parameters = std::move(*parameters);
  return Fitted{std::move(*set), std::move(model)};
}

/// What models explain of sentences that they were not trained on, left out in turn.
Result<void> hold_out(std::span<const Utterance* const> sentences,
                      std::span<const Control> controls, const TrainOptions& options,
                      const TrainRun& run) {
  const std::size_t folds = std::min(kFolds, sentences.size());
  const std::size_t tried = sentences.size() >= kEnoughForOneFold ? 1 : folds;
  HeldOutShare share;
  for (std::size_t fold = 0; folds > 1 && fold < tried; ++fold) {
    if (!run.report("held out", double(fold) / double(tried))) return TrainRun::cancelled();
    std::vector<const Utterance*> in, out;
    for (std::size_t s = 0; s < sentences.size(); ++s)
      (s % folds == fold ? out : in).push_back(sentences[s]);
    TrainSummary none;
    const ProgressFunction quiet;
    TrainRun apart{none, quiet, false};
    const auto fitted = fit(in, options, apart);
    if (!fitted) continue;  // nothing is spoken in what is left
    share.add(fitted->model, out, options.threads);
  }
  share.note(controls, run.summary);
  return {};
}

}  // namespace

Result<Model> train(std::span<const Utterance> utterances, const TrainOptions& options,
                    TrainSummary* summary, const ProgressFunction& progress) {
  const auto begin = std::chrono::steady_clock::now();
  if (auto ok = validate(options); !ok) return ok.error();
  const auto mended = remove_glitches(sorted_sentences(utterances));
  const auto& sentences = mended.sentences;
  TrainSummary own;
  TrainSummary& out = summary != nullptr ? *summary : own;
  out = {};
  out.glitches = mended.glitches;
  TrainRun run{out, progress, summary != nullptr};
  auto fitted = fit(sentences, options, run);
  if (!fitted) return fitted.error();
  const auto& [set, model] = *fitted;
  if (summary == nullptr) return std::move(fitted->model);
  summarise(set, sentences, out);
  review_sentences(set, model, sentences, options.threads, out);
  note_phones(model, out);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!out.held_out)
    if (auto ok = hold_out(sentences, model.controls, options, run); !ok) return ok.error();
  if (auto alignment = check_alignment(sentences, options.threads))
    out.alignment = std::move(*alignment);
  add_warnings(out);
  return std::move(fitted->model);
}

}  // namespace animeme::dam
