// Training.
#include "dam/training/train.h"

#include <filesystem>

#include "dam/signal/limits.h"
#include "dam/training/adapt.h"
#include "tools/bindings/python/python_internal.h"
#include "tools/formats/files/files.h"
#include "tools/formats/inspect/adaptation.h"
#include "tools/formats/inspect/training.h"

namespace animeme::python {

namespace {

dam::TrainOptions options_of(const std::string& method, int threads, int max_iterations,
                             double ridge, const std::string& attribution, std::size_t sentences) {
  dam::TrainOptions options;
  const auto found = dam::find_method(method);
  if (!found) throw py::value_error("method is none that train() knows: " + method);
  options.method = *found;
  options.threads = threads;
  options.max_iterations = max_iterations;
  options.refined.ridge = ridge;
  options.attribution = attribution;
  options.provenance = "animeme " ANIMEME_VERSION ", method " + method + ", " +
                       std::to_string(sentences) + " utterances";
  return options;
}

// What controls can be, if the folder of the corpus says so.
Result<void> set_limits(const std::string& folder, dam::Model& model) {
  const auto path = std::filesystem::path(folder) / "limits.tsv";
  std::error_code none;
  if (folder.empty() || !std::filesystem::exists(path, none)) return {};
  const auto text = tools::read_text_file(path.string());
  if (!text) return text.error();
  std::vector<std::string> names;
  for (const dam::Control& control : model.controls) names.push_back(control.name);
  auto limits = dam::read_limits(*text, names);
  if (!limits) return std::move(limits).error().in_file(path.string());
  model.limits = std::move(*limits);
  return {};
}

// The model, with its summary and what wants attention.
struct Made {
  Model model;
  std::vector<std::string> warnings;
};

Result<Made> train_all(const Corpus& corpus, const dam::TrainOptions& options,
                       const dam::ProgressFunction& progress) {
  dam::TrainSummary summary;
  auto model = dam::train(corpus.corpus.utterances, options, &summary, progress);
  if (!model) return model.error();
  if (auto done = set_limits(corpus.folder, *model); !done) return done.error();
  std::string json = inspect::training_json("", *model, summary,
                                            {corpus.corpus.duration(), {}, corpus.corpus.left_out});
  return Made{{std::move(*model), std::move(json)}, std::move(summary.warnings)};
}

Result<Made> adapt_all(const dam::Model& base, const Corpus& corpus,
                       const dam::TrainOptions& options, const dam::ProgressFunction& progress) {
  dam::AdaptReport report;
  auto model = dam::adapt(base, corpus.corpus.utterances, options, &report, progress);
  if (!model) return model.error();
  if (auto done = set_limits(corpus.folder, *model); !done) return done.error();
  std::string json = inspect::adaptation_json("", "base", *model, report, corpus.corpus.left_out);
  return Made{{std::move(*model), std::move(json)}, std::move(report.warnings)};
}

Model train(const py::object& sentences, const std::string& method, const Model* base, int threads,
            int max_iterations, double ridge, const std::string& attribution,
            const py::object& progress) {
  const auto corpus = corpus_of(sentences);
  const dam::TrainOptions options = options_of(method, threads, max_iterations, ridge, attribution,
                                               corpus->corpus.utterances.size());
  Watch watch(progress);
  const dam::ProgressFunction told = [&watch](const dam::Progress& now) {
    return watch.go_on(now.done, now.stage);
  };
  auto made = unlocked([&] {
    return base == nullptr ? train_all(*corpus, options, told)
                           : adapt_all(base->model, *corpus, options, told);
  });
  watch.rethrow();
  if (!made && !corpus->folder.empty()) raise(std::move(made).error().in_file(corpus->folder));
  Made done = value_of(std::move(made));
  for (const std::string& text : done.warnings) warn(text);
  return std::move(done.model);
}

}  // namespace

void bind_train(py::module_& module) {
  module.def("train", &train, py::arg("corpus"), py::kw_only(), py::arg("method") = "dam",
             py::arg("base") = py::none(), py::arg("threads") = 0, py::arg("max_iterations") = 30,
             py::arg("ridge") = 0.0, py::arg("attribution") = "", py::arg("progress") = py::none(),
             R"(Trains a Model from recordings of a character.

corpus: a Corpus, or Sentences with the same controls and rate.
method: "dam", or for comparison: "dam-paper", "cohen-massaro", "mmm", "triphone", "viseme",
    "mean".
base: for little data: a Model of "dam" to adapt to these sentences.
threads: 0: as many as the machine has; the model is the same, bit by bit, for any number.
max_iterations: maximum number of steps, 0..1000.
ridge: for "dam": factor of all ridges; 0 chooses it by held-out sentences.
attribution: whom to name when the model is passed on; kept in it.
progress: called now and then with (share 0..1 of the stage, stage); what it raises ends the
    training, and so does Ctrl-C.

What wants attention is warned of as InputWarning. Raises Error. Other threads run meanwhile.)");
}

}  // namespace animeme::python
