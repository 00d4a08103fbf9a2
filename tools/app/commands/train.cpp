#include "dam/training/train.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "tools/app/commands/bounds.h"
#include "tools/app/commands/brief_help.h"
#include "tools/app/commands/shard.h"
#include "tools/app/commands/train_base.h"
#include "tools/app/commands/train_parts.h"

namespace animeme::tools {

namespace {

struct TrainOptions {
  CorpusSettings corpus;
  std::string output;
  std::string base;
  std::string method = "dam";
  dam::TrainOptions train;
  PartSettings parts;
  std::string shard;
  bool free_time = false;
  bool single_mode = false;
  bool plain_sum = false;
  bool json = false;
};

dam::TrainOptions train_options(const TrainOptions& options) {
  dam::TrainOptions train = options.train;
  train.method = *dam::find_method(options.method);
  train.animeme.modes = !options.single_mode;
  train.animeme.normalised = !options.plain_sum;
  if (options.free_time) train.animeme.time_margin = std::numeric_limits<double>::infinity();
  return train;
}

Result<int> run_whole(const TrainOptions& options) {
  Result<dam::Corpus> corpus = read_corpus(options.corpus);
  if (!corpus) return corpus.error();
  dam::TrainOptions train = train_options(options);
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
  line.clear();
  if (auto done = set_limits(options.corpus, *model); !done) return done.error();
  for (const std::string& text : summary.warnings) warn(text);
  if (auto written = write_file(options.output, dam::write_model(*model)); !written) {
    return written.error();
  }
  tell_training(options.output, *model, summary, {corpus->duration(), {}, corpus->left_out},
                options.json);
  return kOk;
}

// What does not go together, in a sentence; empty if all is well.
std::string misuse(const TrainOptions& options) {
  const bool accumulates = !options.parts.accumulate.empty(), merges = !options.parts.merge.empty();
  if (accumulates && merges) return "--accumulate and --merge are two steps; give one of them";
  if (merges && !options.corpus.folder.empty())
    return "--merge takes files of sums and no corpus; leave " + options.corpus.folder + " out";
  if (!merges && options.corpus.folder.empty())
    return "a corpus folder is needed, or --merge with files of sums";
  if (accumulates != options.output.empty())
    return accumulates ? "--accumulate writes sums and no model; leave -o out and use --merge later"
                       : "-o is needed: the model file to write";
  if (options.parts.mpi && (accumulates || merges))
    return "--mpi sums a corpus and makes the model of it; leave --accumulate and --merge out";
  if (!options.shard.empty() && !accumulates)
    return "--shard belongs to --accumulate; a model is made of all of a corpus";
  if (!accumulates && !options.parts.mpi && !options.parts.dominance.empty())
    return "--dominance belongs to --accumulate and --mpi; sums that are merged bring their own";
  if (!options.corpus.lag.empty() && merges)
    return "--lag belongs to the step that reads a corpus; sums cannot be shifted";
  const bool sums = accumulates || merges || options.parts.mpi;
  if (options.corpus.lag == "auto" && sums)
    return "--lag auto looks at all sentences at once; give sums a number of ms";
  if (!options.base.empty() && (sums || options.method != "dam"))
    return "--base is for a corpus and --method dam, without --accumulate, --merge and --mpi";
  if (sums && options.method != "dam") return "sums exist for --method dam only";
  return {};
}

// Options that mean nothing to most methods: said, rather than swallowed.
std::string misplaced(const CLI::App& app, const std::string& method) {
  const std::pair<const char*, const char*> owners[] = {
      {"--order", "dam-paper"},
      {"--single-mode", "dam-paper"},
      {"--plain-sum", "dam-paper or cohen-massaro"},
      {"--free-time", "dam-paper or cohen-massaro"},
      {"--ridge", "dam-paper or cohen-massaro"},
      {"--ridge-factor", "dam"},
      {"--states", "mmm"},
  };
  for (const auto& [option, owner] : owners) {
    const std::string names = std::string(" ") + owner + " ";
    if (app.count(option) == 0 || names.find(" " + method + " ") != std::string::npos) continue;
    return std::string(option) + " belongs to --method " + owner + ", not to " + method;
  }
  return {};
}

Result<int> run(const CLI::App& app, TrainOptions& options) {
  std::string text = misuse(options);
  if (!options.shard.empty())
    read_shard(options.shard, options.corpus.shard, options.corpus.shards);
  if (!text.empty()) return usage_error(text);
  text = misplaced(app, options.method);
  if (!text.empty()) return usage_error(text);
  if (!options.parts.merge.empty())
    return merge(options.parts, options.output, options.corpus, train_options(options),
                 options.json);
  if (!options.parts.accumulate.empty())
    return accumulate(options.parts, options.corpus, train_options(options), options.json);
  if (options.parts.mpi)
    return train_over_mpi(options.parts, options.output, options.corpus, train_options(options),
                          options.json);
  if (!options.base.empty())
    return train_on_base(options.base, options.corpus, options.output, train_options(options),
                         options.json);
  return run_whole(options);
}

void add_part_options(CLI::App& app, PartSettings& parts, std::string& shard) {
  add_output(app.add_option("--accumulate", parts.accumulate,
                            "Add the sentences, one at a time, to this file of sums instead of "
                            "training; a file that is there is continued and counts no sentence "
                            "twice"),
             {});
  app.add_option(
      "--dominance", parts.dominance,
      "With --accumulate and --mpi: a model of the method dam (a file, or builtin) whose "
      "dominance the sums are taken for; the same for all parts; default: start values");
  app.add_option("--save-every", parts.save_every,
                 "With --accumulate: save after so many new sentences")
      ->check(between(1, 1000000))
      ->capture_default_str();
  app.add_option("--shard", shard,
                 "With --accumulate: only these sentences, by their ids: 1/4 to 4/4")
      ->option_text("I/N")
      ->check(written_so(problem_of_shard));
  app.add_flag(
      "--mpi", parts.mpi,
      "Under mpirun: every process takes sums of its part of the corpus, the first one makes "
      "the model of all");
  app.add_option("--merge", parts.merge, "Train on the sums of these files instead of a corpus");
}

Action add_train(CLI::App& app) {
  auto options = std::make_shared<TrainOptions>();
  app.add_option("corpus", options->corpus.folder,
                 "Folder with utterances.tsv, phonemes/ID.tsv and fap/ID.csv");
  add_output(app.add_option("-o,--output", options->output, "Model file to write"), {".dam"});
  app.add_option("--method", options->method, "Kind of model")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  app.add_option("--base", options->base,
                 "Little material: bend this model to it in place of learning everything: builtin, "
                 "a model file, or "
                 "a folder with a corpus of somebody else");
  app.add_option("--split", options->corpus.split, "Train on these rows only, e.g. train");
  add_corpus_options(app, options->corpus);
  add_lag_option(app, options->corpus);
  app.add_option("--controls", options->corpus.controls,
                 "Controls to learn: FAP numbers (3-13,51-60) or column names; default: all")
      ->delimiter(',');
  app.add_option("--limits", options->corpus.limits,
                 "Table of what controls can be: control, low, high, opposite; default: limits.tsv "
                 "of the corpus, "
                 "else 0..1 for ARKit's shapes and for what never leaves 0..1")
      ->option_text("FILE");
  app.add_option("--order", options->train.animeme.order, "dam-paper: degree M of the polynomials")
      ->option_text("0..8=4")
      ->check(between(0, 8));
  app.add_option("--states", options->train.trajectory.states,
                 "mmm: Gaussians a phone, one for each part of its time")
      ->option_text("1..8=3")
      ->check(between(1, 8));
  app.add_flag("--single-mode", options->single_mode, "dam-paper: one mode a phone");
  app.add_flag("--plain-sum", options->plain_sum,
               "Methods of the paper: plain sum of Eq. 2, not divided by the sum of dominances");
  app.add_flag("--free-time", options->free_time,
               "Methods of the paper: extrapolate the polynomials freely");
  app.add_option("--ridge-factor", options->train.refined.ridge,
                 "dam: all ridges times this; 0 chooses by held-out sentences")
      ->check(between(0.0, 1000.0))
      ->capture_default_str();
  app.add_option("--ridge", options->train.animeme.ridge,
                 "Methods of the paper: ridge on the coefficients, in frames")
      ->check(at_least_zero())
      ->capture_default_str();
  app.add_option("--max-iterations", options->train.max_iterations, "Steps at most")
      ->check(between(0, 1000))
      ->capture_default_str();
  app.add_option("--threads", options->train.threads, "0: as the machine has")
      ->check(between(0, 1024));
  app.add_option("--attribution", options->train.attribution,
                 "Whom to name when the model is passed on; kept in the model");
  add_part_options(app, options->parts, options->shard);
  app.add_flag("--json", options->json, "Machine-readable summary on standard output");
  show_in_help_all(
      app, "Methods that stand beside ours for comparison",
      {"--order", "--states", "--single-mode", "--plain-sum", "--free-time", "--ridge"});
  return [&app, options] { return run(app, *options); };
}

}  // namespace

const Command kTrain{
    "train", "Learn how a character talks from aligned recordings",
    "  animeme train my_corpus -o me.dam\n"
    "  animeme train half_a_minute --base builtin -o me.dam\n"
    "  animeme train late_takes --lag auto -o me.dam\n"
    "  animeme train grid_s1 --split train --controls 3-13,16,17,51-60 -o grid_s1.dam\n"
    "  animeme train large/a --accumulate a.stats --dominance base.dam   (here)\n"
    "  animeme train large/b --accumulate b.stats --dominance base.dam   (elsewhere)\n"
    "  animeme train --merge a.stats b.stats -o large.dam\n"
    "  mpirun -n 8 animeme train large --mpi --dominance base.dam -o large.dam",
    add_train};

}  // namespace animeme::tools
