#include "dam/training/train.h"

#include <utility>

#include "tools/app/commands/options.h"
#include "tools/app/commands/shard.h"
#include "tools/app/commands/train_base.h"
#include "tools/app/commands/train_parts.h"
#include "tools/formats/common/text.h"

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
  std::vector<std::pair<const Option*, const char*>> of_methods;  // options of some methods only
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

// Options that the method ignores are an error.
std::string misplaced(const TrainOptions& options) {
  for (const auto& [option, owner] : options.of_methods) {
    const std::string names = std::string(" ") + owner + " ";
    const bool fits = names.find(" " + options.method + " ") != std::string::npos;
    if (!option->given() || fits) continue;
    return option->name() + " belongs to --method " + owner + ", not to " + options.method;
  }
  return {};
}

Result<int> run(TrainOptions& options) {
  std::string text = misuse(options);
  if (!options.shard.empty())
    read_shard(options.shard, options.corpus.shard, options.corpus.shards);
  if (!text.empty()) return usage_error(text);
  text = misplaced(options);
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

void add_part_options(OptionTable& cli, PartSettings& parts, std::string& shard) {
  cli.add("--accumulate", parts.accumulate,
          "Add the sentences one by one to this file of statistics instead of training; an "
          "existing file is continued, and no sentence is counted twice")
      ->output("");
  cli.add("--dominance", parts.dominance,
          "With --accumulate and --mpi: a model of the method dam (a file, or builtin) that "
          "provides the dominance; the same for all parts; default: initial values");
  cli.add("--save-every", parts.save_every, "With --accumulate: save after so many new sentences")
      ->between(1, 1000000)
      ->show_default();
  cli.add("--shard", shard,
          "With --accumulate: use only this part of the sentences, chosen by their ids: 1/4 "
          "to 4/4")
      ->value("I/N")
      ->check(problem_of_shard);
  cli.add("--mpi", parts.mpi,
          "Under mpirun: each process accumulates its part of the corpus, the first one "
          "trains the model");
  cli.add("--merge", parts.merge, "Train on the statistics in these files instead of a corpus");
}

void add_options(OptionTable& cli, TrainOptions& options) {
  cli.add("corpus", options.corpus.folder,
          "Folder with utterances.tsv, phonemes/ID.tsv and fap/ID.csv");
  cli.add("-o,--output", options.output, "Model file to write")->output(".dam");
  cli.add("--method", options.method, "Kind of model")
      ->one_of(joined(method_names(), " "))
      ->show_default();
  cli.add("--base", options.base,
          "For little material: adapt this model instead of learning everything: builtin, a "
          "model file, or a folder with a corpus of another speaker");
  cli.add("--split", options.corpus.split, "Train on these rows only, such as train");
  add_corpus_options(cli, options.corpus);
  add_lag_option(cli, options.corpus);
  cli.add("--controls", options.corpus.controls,
          "Controls to learn: FAP numbers (3-13,51-60) or column names; default: all")
      ->at_commas();
  cli.add("--limits", options.corpus.limits,
          "Table of the limits of controls: control, low, high, opposite; default: "
          "limits.tsv of the corpus, else 0..1 for ARKit blend shapes and for controls that "
          "stay within 0..1")
      ->value("FILE");
  cli.add("--order", options.train.animeme.order, "dam-paper: degree M of the polynomials")
      ->value("0..8=4")
      ->between(0, 8);
  cli.add("--states", options.train.trajectory.states,
          "mmm: Gaussians per phone, one for each part of its time")
      ->value("1..8=3")
      ->between(1, 8);
  cli.add("--single-mode", options.single_mode, "dam-paper: one mode per phone");
  cli.add("--plain-sum", options.plain_sum,
          "Methods of the paper: plain sum of Eq. 2, not divided by the sum of dominances");
  cli.add("--free-time", options.free_time,
          "Methods of the paper: extrapolate the polynomials freely");
  cli.add("--ridge-factor", options.train.refined.ridge,
          "dam: factor for all ridges; 0: chosen on held-out sentences")
      ->between(0.0, 1000.0)
      ->show_default();
  cli.add("--ridge", options.train.animeme.ridge,
          "Methods of the paper: ridge on the coefficients, in frames")
      ->at_least_zero()
      ->show_default();
  cli.add("--max-iterations", options.train.max_iterations, "Most iterations")
      ->between(0, 1000)
      ->show_default();
  cli.add("--threads", options.train.threads, "0: one per core")->between(0, 1024);
  cli.add("--attribution", options.train.attribution,
          "Attribution that licences require; stored in the model");
  add_part_options(cli, options.parts, options.shard);
  cli.add("--json", options.json, "Print a machine-readable summary");
  cli.show_in_help_all("Methods for comparison",
                       "--order --states --single-mode --plain-sum --free-time --ridge");
  const std::pair<const char*, const char*> owners[] = {
      {"--order", "dam-paper"},
      {"--single-mode", "dam-paper"},
      {"--plain-sum", "dam-paper or cohen-massaro"},
      {"--free-time", "dam-paper or cohen-massaro"},
      {"--ridge", "dam-paper or cohen-massaro"},
      {"--ridge-factor", "dam"},
      {"--states", "mmm"},
  };
  for (const auto& [option, owner] : owners)
    options.of_methods.emplace_back(cli.get(option), owner);
}

}  // namespace

const Command kTrain{
    "train", "Train a model of how a character talks from aligned recordings",
    "  animeme train my_corpus -o me.dam\n"
    "  animeme train half_a_minute --base builtin -o me.dam\n"
    "  animeme train late_takes --lag auto -o me.dam\n"
    "  animeme train grid_s1 --split train --controls 3-13,16,17,51-60 -o grid_s1.dam\n"
    "  animeme train large/a --accumulate a.stats --dominance base.dam   (here)\n"
    "  animeme train large/b --accumulate b.stats --dominance base.dam   (elsewhere)\n"
    "  animeme train --merge a.stats b.stats -o large.dam\n"
    "  mpirun -n 8 animeme train large --mpi --dominance base.dam -o large.dam",
    set_up<TrainOptions>};

}  // namespace animeme::tools
