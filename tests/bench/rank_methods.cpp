// All methods side by side on a corpus: trains each on the rows that a split column calls "train",
// scores it on those called "test", and prints the table of dam/README.md.
//
//     build/release/bin/rank_methods grid_s1 [--others grid_others] [--controls-folder arkit]
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "dam/corpus.h"
#include "dam/evaluate.h"
#include "dam/evaluate_bootstrap.h"
#include "dam/train.h"

namespace {

using namespace animeme;  // NOLINT: a program

struct Variant {
  std::string name;
  dam::TrainOptions options;
};

std::vector<Variant> variants() {
  std::vector<Variant> list;
  const auto add = [&](const char* name, dam::Method method, auto change) {
    Variant variant{name, {}};
    variant.options.method = method;
    change(variant.options);
    list.push_back(variant);
  };
  const auto plain = [](dam::TrainOptions&) {};
  add("`dam`", dam::Method::dam, plain);
  add("`dam-paper`", dam::Method::dam_paper, plain);
  add("`dam-paper --plain-sum --free-time`: the printed equations", dam::Method::dam_paper,
      [](dam::TrainOptions& o) {
        o.animeme.normalised = false;
        o.animeme.time_margin = std::numeric_limits<double>::infinity();
      });
  add("`dam-paper --single-mode`", dam::Method::dam_paper,
      [](dam::TrainOptions& o) { o.animeme.modes = false; });
  add("`triphone`", dam::Method::triphone, plain);
  add("`mmm`, 3 states", dam::Method::mmm, plain);
  add("`mmm --states 1`", dam::Method::mmm, [](dam::TrainOptions& o) { o.trajectory.states = 1; });
  add("`cohen-massaro`", dam::Method::cohen_massaro, plain);
  add("`cohen-massaro --plain-sum`", dam::Method::cohen_massaro,
      [](dam::TrainOptions& o) { o.animeme.normalised = false; });
  add("`viseme`", dam::Method::viseme, plain);
  add("`mean`", dam::Method::mean, plain);
  return list;
}

[[noreturn]] void stop(const Error& error) {
  std::fprintf(stderr, "rank_methods: %s\n", error.describe().c_str());
  std::exit(3);
}

template <class T>
T need(Result<T> result) {
  if (!result) stop(result.error());
  return std::move(*result);
}

void print_cells(const dam::Evaluation& e, const dam::Evaluation& best, bool first) {
  std::printf(" | %.3f / %.2f / %.2f", e.nrmse, e.l2, e.correlation);
  if (first) {
    std::printf(" | ");
  } else {
    const dam::PairedDifference d = need(dam::paired_difference(e, best));
    std::printf(" | %+.1f %% (%+.1f to %+.1f)", 100 * d.nrmse.difference / best.nrmse,
                100 * d.nrmse.low / best.nrmse, 100 * d.nrmse.high / best.nrmse);
  }
  if (e.closure.phones > 0 && !e.measures.empty())
    std::printf(" | %.0f / %.2f | %.0f %% (%.1f)", e.measures[0].rmse, e.measures[0].correlation,
                100 * e.closure.predicted, e.closure.false_per_minute);
  else
    std::printf(" | | ");
}

int run(const std::string& folder, const std::string& others, const std::string& controls) {
  dam::CorpusOptions read;
  read.controls_folder = controls;
  read.skip_missing = true;
  const dam::Corpus corpus = need(dam::read_corpus(folder, read));
  dam::Corpus other;
  if (!others.empty()) other = need(dam::read_corpus(others, read));
  const char* const columns[] = {"split", "heldout_word_split"};
  std::printf("| method");
  for (const char* column : columns)
    std::printf(
        " | `%s`: NRMSE / L2 / corr | more than `dam` (95 %%) | gap RMSE / corr | "
        "P B M closed (false a minute)",
        column);
  std::printf(" | training, s%s |\n", others.empty() ? "" : " | other speakers: gap corr");
  std::printf("|---|---|---|---|---|---|---|---|---|---|%s\n", others.empty() ? "" : "---|");
  dam::Evaluation best[2];
  bool first = true;
  for (const Variant& variant : variants()) {
    std::printf("| %s", variant.name.c_str());
    double seconds = 0;
    std::optional<dam::Model> model;
    for (std::size_t i = 0; i < 2; ++i) {
      dam::TrainSummary summary;
      const auto rows = dam::select(corpus, columns[i], "train");
      dam::Model trained = need(dam::train(rows, variant.options, &summary));
      if (i == 0) seconds = summary.seconds;
      const dam::Evaluation e =
          need(dam::evaluate(trained, dam::select(corpus, columns[i], "test")));
      if (first) best[i] = e;
      print_cells(e, best[i], first);
      if (i == 0) model = std::move(trained);
    }
    std::printf(" | %.1f", seconds);
    if (!others.empty())
      std::printf(" | %.3f", need(dam::evaluate(*model, other.utterances)).gap_correlation);
    std::printf(" |\n");
    std::fflush(stdout);
    first = false;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Trains and scores every method on both splits of a corpus; prints Markdown"};
  std::string folder, others, controls = "fap";
  app.add_option("corpus", folder, "Folder with the columns split and heldout_word_split")
      ->required();
  app.add_option("--others", others, "Corpus of other speakers, scored by the correlation of gaps");
  app.add_option("--controls-folder", controls, "fap or arkit")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return run(folder, others, controls);
}
