#include "dam/evaluate.h"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/commands/model_input.h"

namespace animeme::tools {

namespace {

struct Options {
  std::string model;
  CorpusSettings corpus;
  dam::EvaluateOptions evaluate;
  bool no_closure = false;
  bool json = false;
};

nlohmann::ordered_json to_json(const dam::Evaluation& result) {
  nlohmann::ordered_json controls = nlohmann::ordered_json::array();
  for (const dam::ControlScore& control : result.controls) {
    controls.push_back({{"name", control.name},
                        {"scored", control.scored},
                        {"rmse", control.rmse},
                        {"nrmse", control.nrmse},
                        {"max", control.largest},
                        {"correlation", control.correlation}});
  }
  nlohmann::ordered_json measures = nlohmann::ordered_json::object();
  for (const dam::MeasureScore& measure : result.measures) {
    measures[measure.name] = {{"rmse", measure.rmse}, {"correlation", measure.correlation}};
  }
  nlohmann::ordered_json utterances = nlohmann::ordered_json::array();
  for (const dam::UtteranceScore& one : result.per_utterance) {
    utterances.push_back(
        {{"id", one.id}, {"frames", one.frames}, {"nrmse", one.nrmse}, {"l2", one.l2}});
  }
  return {{"utterances", result.utterances},
          {"frames", result.frames},
          {"mean_nrmse", result.nrmse},
          {"still_face_nrmse", result.still_nrmse},
          {"mean_l2", result.l2},
          {"mean_correlation", result.correlation},
          {"closure",
           {{"phones", result.closure.phones},
            {"measured", result.closure.measured},
            {"predicted", result.closure.predicted},
            {"false_closures", result.closure.false_closures},
            {"false_per_minute", result.closure.false_per_minute}}},
          {"measures", measures},
          {"controls", controls},
          {"per_utterance", utterances}};
}

void print(const dam::Evaluation& result) {
  std::printf("%zu utterances, %zu frames of speech +-0.2 s\n\n", result.utterances, result.frames);
  std::printf("mean NRMSE        %.4f   (RMSE / training standard deviation, scored controls)\n",
              result.nrmse);
  std::printf("  of a still face %.4f   (mean pose of the training speech)\n", result.still_nrmse);
  std::printf("mean L2           %.3f\n", result.l2);
  std::printf("mean correlation  %.3f\n", result.correlation);
  for (const dam::MeasureScore& measure : result.measures) {
    std::printf("%-17s RMSE %.1f, correlation %.3f\n", measure.name.c_str(), measure.rmse,
                measure.correlation);
  }
  if (result.closure.phones > 0) {
    std::printf(
        "P B M closed      %.1f %% (measured %.1f %%) of %zu; false closures %.1f a minute\n",
        100 * result.closure.predicted, 100 * result.closure.measured, result.closure.phones,
        result.closure.false_per_minute);
  }
  std::printf("\n%-28s %8s %8s %8s %8s\n", "control", "RMSE", "NRMSE", "max", "corr");
  for (const dam::ControlScore& control : result.controls) {
    std::printf("%-28s %8.2f %8.3f %8.1f %8.3f%s\n", control.name.c_str(), control.rmse,
                control.nrmse, control.largest, control.correlation,
                control.scored ? "" : "  (not scored)");
  }
}

Result<int> run(const Options& options) {
  Result<dam::Model> model = read_model_or_builtin(options.model);
  if (!model) return model.error();
  CorpusSettings settings = options.corpus;
  settings.controls.clear();
  for (const dam::Control& control : model->controls) settings.controls.push_back(control.name);
  Result<dam::Corpus> corpus = read_corpus(settings);
  if (!corpus) return corpus.error();
  dam::EvaluateOptions evaluate = options.evaluate;
  evaluate.synthesis.closure = !options.no_closure;
  Result<dam::Evaluation> result = dam::evaluate(*model, corpus->utterances, evaluate);
  if (!result) return result.error().in_file(options.corpus.folder);
  if (options.json) {
    std::printf("%s\n", to_json(*result).dump(2).c_str());
  } else {
    print(*result);
  }
  return kOk;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("model", options->model, "Model file, or 'builtin'")->required();
  app.add_option("corpus", options->corpus.folder, "Corpus folder, see train")->required();
  app.add_option("--split", options->corpus.split, "Use these rows only, e.g. test");
  add_corpus_options(app, options->corpus);
  app.add_flag("--no-closure", options->no_closure, "Leave out the closure of P, B and M");
  app.add_flag("--json", options->json, "Machine-readable result");
  return [options] { return run(*options); };
}

}  // namespace

const Command kEvaluate{
    "evaluate", "Error of synthesis against recorded motion",
    "  animeme evaluate builtin grid_s1 --split test\n"
    "  animeme evaluate words.dam grid_s1 --split-column heldout_word_split --split test --json",
    add};

}  // namespace animeme::tools
