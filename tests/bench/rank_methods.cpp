// All methods side by side on a corpus: trains each on the rows that a split column calls "train",
// scores it on those called "test", and prints the table of dam/README.md.
//
//     build/release/bin/rank_methods grid_s1 [--others grid_others] [--controls-folder arkit]
//
// Cross validation inside the rows that are "train" in both columns, by sentence and by words held
// out: how the method dam came about, step by step. The test rows are not read.
//
//     build/release/bin/rank_methods grid_s1 --steps
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <set>
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

/// From dam+f of the lip-sync specification to dam, one change after the other, and changes of dam.
std::vector<Variant> steps() {
  using enum dam::RefinedTerm;
  const auto bit = [](dam::RefinedTerm term) { return 1u << unsigned(term); };
  const std::uint32_t neighbours =
      bit(phone) | bit(class_left) | bit(class_right) | bit(phone_left) | bit(phone_right);
  const std::uint32_t second = bit(class_left_2) | bit(class_right_2);
  std::vector<Variant> list;
  dam::TrainOptions now;
  now.refined.terms = bit(phone);
  now.refined.offset_frames = 1e9;
  now.refined.width_prior = 5;
  now.refined.time_margin = 0.5;
  now.refined.duration_exponent = 0;
  now.refined.ridge = 1;
  const auto add = [&](const char* name) { list.push_back({name, now}); };
  dam::TrainOptions paper;
  paper.method = dam::Method::dam_paper;
  list.push_back({"`dam-paper`", paper});
  add("seconds, left and right, strength; no context");
  now.refined.terms = neighbours;
  add("+ neighbours");
  now.refined.offset_frames = 10;
  add("+ offset of the sentence");
  now.refined.width_prior = 50;
  add("+ firmer prior on the widths");
  now.refined.terms |= bit(duration);
  add("+ own duration");
  now.refined.terms |= second;
  add("+ second neighbours");
  now.refined.time_margin = 0.3;
  add("+ local time within [-0.3, 1.3]");
  now.refined.duration_exponent = 0.3;
  add("+ strength by duration");
  now.refined.terms |= bit(phone_class);
  add("+ curve of the class");
  now.refined.ridge = 0;
  add("+ factor of the ridges chosen: `dam`");
  now = {};
  now.refined.ridge = 0.5;
  add("`dam`, ridges x 0.5");
  now.refined.ridge = 2;
  add("`dam`, ridges x 2");
  now.refined.ridge = 4;
  add("`dam`, ridges x 4");
  now = {};
  now.refined.offset_frames = 1e9;
  add("`dam` without offsets");
  now = {};
  now.refined.width_prior = 5;
  add("`dam`, loose prior on the widths");
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

// ---- cross validation ----

using Sentences = std::vector<dam::Utterance>;

struct Fold {
  Sentences train, test;
};

std::set<std::string> words_of(const dam::Utterance& u) {
  std::set<std::string> words;
  for (const dam::Phone& phone : u.script.phones)
    if (!phone.word.empty()) words.insert(phone.word);
  return words;
}

template <class Held>
Fold fold_of(const Sentences& rows, const Held& held) {
  Fold fold;
  for (std::size_t i = 0; i < rows.size(); ++i)
    (held(i) ? fold.test : fold.train).push_back(rows[i]);
  return fold;
}

constexpr std::size_t kFolds = 3;

/// Every third sentence.
std::vector<Fold> sentence_folds(const Sentences& rows) {
  std::vector<Fold> folds;
  for (std::size_t k = 0; k < kFolds; ++k)
    folds.push_back(fold_of(rows, [&](std::size_t i) { return i % kFolds == k; }));
  return folds;
}

/// Sentences with one of a fifth of the words, of those that an eighth of the sentences or fewer
/// have.
std::vector<Fold> word_folds(const Sentences& rows) {
  std::map<std::string, std::size_t> count;
  for (const dam::Utterance& u : rows)
    for (const std::string& word : words_of(u)) ++count[word];
  std::vector<std::string> words;
  for (const auto& [word, n] : count)
    if (n * 8 <= rows.size()) words.push_back(word);
  std::vector<Fold> folds;
  for (std::size_t k = 0; k < kFolds; ++k) {
    std::set<std::string> out;
    for (std::size_t i = k; i < words.size(); i += 5) out.insert(words[i]);
    folds.push_back(fold_of(rows, [&](std::size_t i) {
      const auto own = words_of(rows[i]);
      return std::any_of(own.begin(), own.end(),
                         [&](const std::string& word) { return out.contains(word); });
    }));
  }
  return folds;
}

double mean_nrmse(const std::vector<Fold>& folds, const Variant& variant) {
  double sum = 0;
  for (const Fold& fold : folds) {
    const dam::Model model = need(dam::train(fold.train, variant.options));
    sum += need(dam::evaluate(model, fold.test)).nrmse / double(folds.size());
  }
  return sum;
}

int run_steps(const std::string& folder, const std::string& controls) {
  dam::CorpusOptions read;
  read.controls_folder = controls;
  read.skip_missing = true;
  dam::Corpus corpus = need(dam::read_corpus(folder, read));
  corpus.utterances = dam::select(corpus, "split", "train");
  const Sentences rows = dam::select(corpus, "heldout_word_split", "train");
  const auto by_sentence = sentence_folds(rows), by_word = word_folds(rows);
  std::printf("%zu sentences; held out by word: %zu, %zu, %zu of them\n\n", rows.size(),
              by_word[0].test.size(), by_word[1].test.size(), by_word[2].test.size());
  std::printf("| | NRMSE, by sentence | by word |\n|---|---|---|\n");
  for (const Variant& variant : steps()) {
    std::printf("| %s | %.4f | %.4f |\n", variant.name.c_str(), mean_nrmse(by_sentence, variant),
                mean_nrmse(by_word, variant));
    std::fflush(stdout);
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
  bool only_steps = false;
  app.add_flag("--steps", only_steps,
               "Cross validation of the steps to dam inside the training rows");
  CLI11_PARSE(app, argc, argv);
  return only_steps ? run_steps(folder, controls) : run(folder, others, controls);
}
