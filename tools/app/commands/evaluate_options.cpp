#include "tools/app/commands/evaluate_options.h"

#include "tools/app/commands/options.h"
#include "tools/app/commands/train_base.h"
#include "tools/formats/common/text.h"

namespace animeme::tools {

namespace {

void add_thresholds(OptionTable& cli, EvaluateOptions& options) {
  cli.add("--max-nrmse", options.max_nrmse, "Exit code 1 if the mean NRMSE is above this")
      ->value("ERROR")
      ->at_least_zero();
  cli.add("--min-closed", options.min_closed,
          "Exit code 1 if less than this percentage of P B M is closed")
      ->value("SHARE")
      ->between(0.0, 100.0);
  cli.add("--max-false-per-minute", options.max_false,
          "Exit code 1 if there are more false closures")
      ->value("N")
      ->at_least_zero();
}

void add_folds(OptionTable& cli, EvaluateOptions& options) {
  cli.add("--folds", options.folds,
          "Instead of a model: train this many models, each without its share of the "
          "sentences, which it then speaks (cross-validation)")
      ->value("N")
      ->between(2, 1000);
  cli.add("--method", options.method, "With --folds: kind of model, see train")
      ->one_of(joined(method_names(), " "))
      ->show_default();
  cli.add("--base", options.base, "With --folds: base model to adapt, see train");
  cli.add("--controls", options.controls, "With --folds: controls to learn, see train")
      ->at_commas();
}

void add_speakers(OptionTable& cli, EvaluateOptions& options) {
  cli.add("--speakers", options.speakers,
          "Compare training for strangers: warp this corpus of one speaker into others, and score "
          "a few own sentences alone, the model as it is, and the model adapted to them; the "
          "model is also scored on each sentence of CORPUS")
      ->value("FILE")
      ->excludes("--tracks --folds --against --codec --report --picture");
  cli.add("--sentences", options.sizes, "With --speakers: own sentences to train on")
      ->at_commas()
      ->value("N,N=5,10,20")
      ->check([](const std::string& text) {
        return problem_of_number(text, 1, 100000, "a number of sentences, as in 5,10,20");
      })
      ->needs("--speakers");
  cli.add("--copies", options.copies, "With --speakers: number of warped speakers")
      ->between(1, 64)
      ->show_default()
      ->needs("--speakers");
  cli.add("--base-sentences", options.base_sentences,
          "With --speakers: in place of the model, a base of another warped speaker for each one, "
          "trained on at most so many sentences that are not used otherwise")
      ->value("N")
      ->between(1, 100000)
      ->needs("--speakers");
}

}  // namespace

void add_options(OptionTable& cli, EvaluateOptions& options) {
  cli.add("model", options.system, "Model file, or 'builtin'; the corpus with --folds or --tracks")
      ->required();
  cli.add("corpus", options.corpus.folder, "Corpus folder, see train");
  cli.add("--tracks", options.tracks,
          "Instead of the model: folder with ID.csv or ID.fap of another system");
  add_folds(cli, options);
  add_speakers(cli, options);
  cli.add("--split", options.corpus.split, "Use these rows only, such as test");
  add_lag_option(cli, options.corpus);
  add_corpus_options(cli, options.corpus);
  cli.add("--seen-split", options.seen_split,
          "Rows that the model was trained on, to tell seen from unseen contexts");
  cli.add("--closed-gap", options.evaluate.score.closed_gap,
          "Lips count as closed below this inner gap, FAP units")
      ->between(-1e4, 1e4)
      ->show_default();
  cli.add("--no-closure", options.no_closure, "Do not force lip closure on P, B and M");
  cli.add("--sharpness", options.evaluate.synthesis.sharpness,
          "As of speak: 0 has the least error, 1 is as quick as people are")
      ->value("0..3=1")
      ->between(0.0, dam::kMostSharpness);
  cli.add("--articulate", options.evaluate.synthesis.articulation,
          "As of speak: clearer vowels than learned; 0 unless given")
      ->value("0..2=0")
      ->between(0.0, dam::kMostArticulation);
  cli.add("--against", options.against,
          "A second model or folder of tracks: print the difference with its confidence "
          "interval");
  cli.add("--draws", options.draws, "Bootstrap draws over sentences")
      ->value("N=1000")
      ->between(1, 1000000);
  cli.add("--rules", options.rules,
          "Print what closure, sharpness and articulation each add to the errors of a model")
      ->excludes("--tracks --folds");
  cli.add("--codec", options.codec, "Print the error of the codec separately, and its bit rate");
  add_coding_options(cli, options.stream);
  for (const char* name : {"--quant", "--rms", "--kbps"}) cli.get(name)->needs("--codec");
  cli.add("--picture", options.picture,
          "Plot the best, median and worst sentence, .svg, .pdf or .png")
      ->output(".svg .pdf .png", OutputKind::file);
  cli.add("--report", options.report,
          "Write a report page with all results and three sentences on the head: .html")
      ->output(".html .htm", OutputKind::file);
  add_thresholds(cli, options);
  cli.add("--full", options.full, "Print tables by control, phoneme, viseme, class and sentence");
  cli.add("--json", options.json, "Print a machine-readable result with all tables");
  cli.show_in_help_all("Details of the comparison",
                       "--split-column --controls-folder --closed-gap --draws");
  cli.show_in_help_all("Comparison of training for strangers",
                       "--sentences --copies --base-sentences");
}

}  // namespace animeme::tools
