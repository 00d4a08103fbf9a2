#include "tools/app/commands/evaluate_options.h"

#include <CLI/CLI.hpp>

#include "tools/app/commands/bounds.h"
#include "tools/app/commands/brief_help.h"
#include "tools/app/commands/outputs.h"
#include "tools/app/commands/train_base.h"

namespace animeme::tools {

namespace {

void add_thresholds(CLI::App& app, EvaluateOptions& options) {
  app.add_option("--max-nrmse", options.max_nrmse, "Exit code 1 if the mean NRMSE is above this")
      ->option_text("ERROR")
      ->check(at_least_zero());
  app.add_option("--min-closed", options.min_closed,
                 "Exit code 1 if less than this percentage of P B M is closed")
      ->option_text("SHARE")
      ->check(between(0.0, 100.0));
  app.add_option("--max-false-per-minute", options.max_false,
                 "Exit code 1 if there are more false closures")
      ->option_text("N")
      ->check(at_least_zero());
}

void add_folds(CLI::App& app, EvaluateOptions& options) {
  app.add_option("--folds", options.folds,
                 "In place of a model: train as many, each without its share of the sentences, "
                 "which it then speaks")
      ->option_text("N")
      ->check(between(2, 1000));
  app.add_option("--method", options.method, "With --folds: kind of model, see train")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  app.add_option("--base", options.base, "With --folds: bend this model, see train");
  app.add_option("--controls", options.controls, "With --folds: controls to learn, see train")
      ->delimiter(',');
}

}  // namespace

void add_options(CLI::App& app, EvaluateOptions& options) {
  app.add_option("model", options.system,
                 "Model file, or 'builtin'; the corpus with --folds or --tracks")
      ->required();
  app.add_option("corpus", options.corpus.folder, "Corpus folder, see train");
  app.add_option("--tracks", options.tracks,
                 "Folder with ID.csv or ID.fap of another system, in place of the model");
  add_folds(app, options);
  app.add_option("--split", options.corpus.split, "Use these rows only, e.g. test");
  add_lag_option(app, options.corpus);
  add_corpus_options(app, options.corpus);
  app.add_option("--seen-split", options.seen_split,
                 "Rows the model was trained on: tells seen from unseen contexts");
  app.add_option("--closed-gap", options.evaluate.score.closed_gap,
                 "Inner gap below which lips count as closed, FAP units")
      ->check(between(-1e4, 1e4))
      ->capture_default_str();
  app.add_flag("--no-closure", options.no_closure, "Leave out the closure of P, B and M");
  app.add_option("--sharpness", options.evaluate.synthesis.sharpness,
                 "As of speak: 0 has the least error, 1 moves more as people do")
      ->option_text("0..3=1")
      ->check(between(0.0, dam::kMostSharpness));
  app.add_option("--articulate", options.evaluate.synthesis.articulation,
                 "As of speak: vowels clearer than learned")
      ->option_text("0..2=0")
      ->check(between(0.0, dam::kMostArticulation));
  app.add_option("--against", options.against,
                 "A second model or folder of tracks: difference with its interval");
  app.add_option("--draws", options.draws, "Draws of the bootstrap over sentences")
      ->option_text("N=1000")
      ->check(between(1, 1000000));
  CLI::Option* codec =
      app.add_flag("--codec", options.codec, "Error of the codec apart, and its bit rate");
  add_coding_options(app, options.stream);
  for (const char* name : {"--quant", "--rms", "--kbps"}) app.get_option(name)->needs(codec);
  add_output(app.add_option("--picture", options.picture,
                            "Curves of the best, median and worst sentence, .svg or .png"),
             {".svg", ".png"}, OutputKind::file);
  add_output(app.add_option(
                 "--report", options.report,
                 "All of it on one page for colleagues, with three sentences on the head: .html"),
             {".html", ".htm"}, OutputKind::file);
  add_thresholds(app, options);
  app.add_flag("--full", options.full, "Tables by control, phoneme, viseme, class and sentence");
  app.add_flag("--json", options.json, "Machine-readable result, with everything");
  show_in_help_all(app, "Details of what is compared",
                   {"--split-column", "--controls-folder", "--closed-gap", "--draws"});
}

}  // namespace animeme::tools
