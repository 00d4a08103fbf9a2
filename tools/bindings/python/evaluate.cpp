// How far a model is from recordings.
#include "dam/evaluation/evaluate.h"

#include <algorithm>

#include "tools/bindings/python/python_internal.h"
#include "tools/formats/inspect/evaluation.h"
#include "tools/formats/inspect/left_out.h"

namespace animeme::python {

namespace {

using inspect::EvaluationReport;

// Sentences with the controls of the model only, as far as they have them.
std::vector<dam::Utterance> narrowed(const std::vector<dam::Utterance>& sentences,
                                     const dam::Model& model) {
  std::vector<dam::Utterance> all;
  for (const dam::Utterance& from : sentences) {
    dam::Utterance& to = all.emplace_back(from);
    std::vector<std::size_t> columns;
    to.signal.names.clear();
    for (const dam::Control& control : model.controls) {
      const auto& names = from.signal.names;
      const auto found = std::find(names.begin(), names.end(), control.name);
      if (found == names.end()) continue;
      columns.push_back(std::size_t(found - names.begin()));
      to.signal.names.push_back(control.name);
    }
    to.signal.values.clear();
    for (std::size_t frame = 0; frame < from.signal.frames(); ++frame) {
      for (const std::size_t column : columns) {
        to.signal.values.push_back(from.signal.at(frame, column));
      }
    }
  }
  return all;
}

// In batches, so that the user can interrupt it.
Result<std::vector<dam::SentencePair>> speak_all(const dam::Model& model,
                                                 const std::vector<dam::Utterance>& sentences,
                                                 const dam::EvaluateOptions& options,
                                                 Watch& watch) {
  constexpr std::size_t kBatch = 32;
  std::vector<dam::SentencePair> pairs;
  for (std::size_t first = 0; first < sentences.size(); first += kBatch) {
    const std::span<const dam::Utterance> batch(sentences.data() + first,
                                                std::min(kBatch, sentences.size() - first));
    auto made = dam::synthesise_pairs(model, batch, options);
    if (!made) return made;
    std::move(made->begin(), made->end(), std::back_inserter(pairs));
    if (!watch.go_on(double(pairs.size()) / double(sentences.size()), "speaking")) {
      return make_error(Code::invalid_argument, "stopped");
    }
  }
  return pairs;
}

std::unique_ptr<EvaluationReport> evaluate(const Model& model, const py::object& sentences,
                                           double sharpness, double articulation, bool closure,
                                           const py::object& seen, int threads,
                                           const py::object& progress) {
  const auto corpus = corpus_of(sentences);
  dam::EvaluateOptions options;
  options.synthesis.sharpness = sharpness;
  options.synthesis.articulation = articulation;
  options.synthesis.closure = closure;
  options.score.threads = threads;
  options.score.scale = model.model.controls;
  if (!seen.is_none()) options.score.seen = dam::seen_contexts(corpus_of(seen)->corpus.utterances);
  auto report = std::make_unique<EvaluationReport>();
  report->left_out = corpus->corpus.left_out;
  report->closed_gap = options.score.closed_gap;
  Watch watch(progress);
  auto done = unlocked([&]() -> Result<void> {
    const auto recorded = narrowed(corpus->corpus.utterances, model.model);
    auto pairs = speak_all(model.model, recorded, options, watch);
    if (!pairs) return pairs.error();
    report->glitches = inspect::leave_out_glitches(*pairs);
    auto result = dam::score(*pairs, options.score);
    if (!result) return result.error();
    report->evaluation = std::move(*result);
    return {};
  });
  watch.rethrow();
  for (const std::string& text : inspect::glitches_text(report->glitches)) warn(text);
  if (!done && !corpus->folder.empty()) raise(std::move(done).error().in_file(corpus->folder));
  value_of(std::move(done));
  return report;
}

}  // namespace

void bind_evaluate(py::module_& module) {
  py::class_<EvaluationReport>(
      module, "Evaluation",
      R"(The result of evaluate(): the error of a model compared with recordings.

str() is the report as text. Scores cover frames of speech and the FAPs of the lips.)")
      .def_property_readonly(
          "nrmse", [](const EvaluationReport& r) { return r.evaluation.nrmse; },
          "Root mean square error in standard deviations, mean over the scored controls.")
      .def_property_readonly(
          "still_nrmse", [](const EvaluationReport& r) { return r.evaluation.still_nrmse; },
          "The same for a face that keeps the mean pose.")
      .def_property_readonly(
          "correlation", [](const EvaluationReport& r) { return r.evaluation.correlation; },
          "Pearson's, -1..1, mean over the scored controls.")
      .def_property_readonly(
          "closed", [](const EvaluationReport& r) { return r.evaluation.closure.predicted; },
          "Share of P, B and M that close the lips, 0..1.")
      .def_property_readonly(
          "sentences", [](const EvaluationReport& r) { return r.evaluation.utterances; },
          "Number of scored sentences.")
      .def(
          "to_dict", [](const EvaluationReport& r) { return loads(inspect::evaluation_json(r)); },
          "The complete result, as the dict that `animeme evaluate --json` prints; its README\n"
          "documents the members.")
      .def("__str__", [](const EvaluationReport& r) { return inspect::evaluation_text(r, false); });

  module.def(
      "evaluate", &evaluate, py::arg("model"), py::arg("corpus"), py::kw_only(),
      py::arg("sharpness") = 1.0, py::arg("articulation") = 0.0, py::arg("closure") = true,
      py::arg("seen") = py::none(), py::arg("threads") = 0, py::arg("progress") = py::none(),
      R"(Synthesises the sentences of a corpus and compares them with its recordings: an Evaluation.

model: the Model to evaluate.
corpus: a Corpus, or Sentences with the same controls and rate.
sharpness, articulation, closure: as for Model.speak(); sharpness 0 has the smallest error.
seen: the training corpus, to distinguish seen from unseen contexts in to_dict().
threads: 0: as many as the machine has.
progress: called from time to time with (share 0..1, "speaking"); an exception ends the evaluation,
    and so does Ctrl-C.

Raises Error. Other threads run meanwhile.)");
}

}  // namespace animeme::python
