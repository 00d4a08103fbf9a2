#include "dam/train.h"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/commands/model_input.h"

namespace animeme::tools {

namespace {

struct Options {
  CorpusSettings corpus;
  std::string output;
  std::string method = "dam";
  dam::TrainOptions train;
  std::string attribution;
  bool free_time = false;
  bool single_mode = false;
  bool plain_sum = false;
  bool json = false;
};

void print(const Options& options, const dam::Corpus& corpus, const dam::Model& model,
           const dam::TrainSummary& summary) {
  if (options.json) {
    nlohmann::ordered_json json = {{"model", options.output},
                                   {"method", dam::method_name(model.method)},
                                   {"utterances", summary.utterances},
                                   {"corpus_seconds", corpus.duration()},
                                   {"frames", summary.frames},
                                   {"phone_occurrences", summary.occurrences},
                                   {"phones", model.phones.size()},
                                   {"modes", summary.modes},
                                   {"controls", model.controls.size()},
                                   {"iterations", summary.iterations},
                                   {"converged", summary.converged},
                                   {"objective", summary.objective},
                                   {"training_seconds", summary.seconds},
                                   {"warnings", summary.warnings}};
    std::printf("%s\n", json.dump(2).c_str());
    return;
  }
  char line[200];
  std::snprintf(line, sizeof line,
                "%zu utterances, %.1f s, %zu phones (%zu occurrences), %zu controls",
                summary.utterances, corpus.duration(), model.phones.size(), summary.occurrences,
                model.controls.size());
  say(summary.modes == 0 ? std::string(line)
                         : line + (", " + std::to_string(summary.modes)) + " modes");
  std::string fit = std::to_string(summary.iterations) + " iterations" +
                    (summary.converged ? "" : " (stopped before convergence)") + ", objective";
  for (const double objective : summary.objective) {
    std::snprintf(line, sizeof line, " %.1f", objective);
    fit += line;
  }
  if (!summary.objective.empty()) say(fit);
  std::snprintf(line, sizeof line, ": trained in %.1f s", summary.seconds);
  say(options.output + line);
}

Result<int> run(const Options& options) {
  Result<dam::Corpus> corpus = read_corpus(options.corpus);
  if (!corpus) return corpus.error();
  dam::TrainOptions train = options.train;
  train.method = *dam::find_method(options.method);
  train.attribution = options.attribution;
  train.animeme.modes = !options.single_mode;
  train.animeme.normalised = !options.plain_sum;
  if (options.free_time) train.animeme.time_margin = std::numeric_limits<double>::infinity();
  train.provenance = "animeme " ANIMEME_VERSION ", method " + options.method + ", " +
                     std::to_string(corpus->utterances.size()) + " utterances" +
                     (options.corpus.split.empty() ? ""
                                                   : ", rows with " + options.corpus.split_column +
                                                         " = " + options.corpus.split);
  dam::TrainSummary summary;
  ProgressLine line("training");
  const auto progress = [&line](const dam::Progress& now) {
    line.update(now.done, now.stage);
    return true;
  };
  Result<dam::Model> model = dam::train(corpus->utterances, train, &summary, progress);
  if (!model) return model.error().in_file(options.corpus.folder);
  for (const std::string& text : summary.warnings) warn(text);
  if (auto written = write_file(options.output, dam::write_model(*model)); !written) {
    return written.error();
  }
  print(options, *corpus, *model, summary);
  return kOk;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const dam::Method method : dam::methods()) names.emplace_back(dam::method_name(method));
  return names;
}

Action add(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("corpus", options->corpus.folder,
                 "Folder with utterances.tsv, phonemes/ID.tsv and fap/ID.csv")
      ->required();
  app.add_option("-o,--output", options->output, "Model file to write")->required();
  app.add_option("--method", options->method, "Kind of model")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  app.add_option("--split", options->corpus.split, "Train on these rows only, e.g. train");
  add_corpus_options(app, options->corpus);
  app.add_option("--controls", options->corpus.controls,
                 "Controls to learn: FAP numbers (3-13,51-60) or column names; default: all")
      ->delimiter(',');
  app.add_option("--order", options->train.animeme.order, "Degree M of the polynomials")
      ->check(CLI::Range(0, 8))
      ->capture_default_str();
  app.add_option("--states", options->train.trajectory.states,
                 "mmm: Gaussians a phone, one for each part of its time")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  app.add_flag("--single-mode", options->single_mode, "One mode a phone, no clustering");
  app.add_flag("--plain-sum", options->plain_sum,
               "Blend by the plain sum of Eq. 2 and do not divide by the sum of dominances");
  app.add_flag("--free-time", options->free_time,
               "Extrapolate the polynomials freely, as the paper's equations say");
  app.add_option("--ridge", options->train.animeme.ridge, "Ridge on the coefficients, in frames")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--max-iterations", options->train.max_iterations, "EM steps at most")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  app.add_option("--threads", options->train.threads, "0: as the machine has")
      ->check(CLI::Range(0, 1024));
  app.add_option("--attribution", options->attribution,
                 "Whom to name when the model is passed on; kept in the model");
  app.add_flag("--json", options->json, "Machine-readable summary on standard output");
  return [options] { return run(*options); };
}

}  // namespace

const Command kTrain{
    "train", "Learn how a character talks from aligned recordings",
    "  animeme train my_corpus -o me.dam\n"
    "  animeme train grid_s1 --split train --controls 3-13,16,17,51-60 -o grid_s1.dam",
    add};

}  // namespace animeme::tools
