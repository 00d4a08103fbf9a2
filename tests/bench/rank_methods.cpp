// All methods side by side on a corpus: trains each on the rows that a split column calls "train",
// scores it on those called "test", and prints the table of dam/measured.md.
//
//     build/release/bin/rank_methods grid_s1 [--others grid_others] [--controls-folder arkit]
//
// Cross validation inside the rows that are "train" in both columns, by sentence and by words held
// out: how the method dam came about, step by step. The test rows are not read.
//
//     build/release/bin/rank_methods grid_s1 --steps
//
// Little data: five random draws of as many training rows as hold some seconds of speech.
//
//     build/release/bin/rank_methods grid_s1 --little 66
//
// Rules: what sharpness, closure and articulation cost, on the test rows and on other speakers.
//
//     build/release/bin/rank_methods grid_s1 --rules [--others grid_others]
//
// Words never heard: random sets of five words; trained on the sentences without them, scored on
// the frames inside them. All rows of the corpus.
//
//     build/release/bin/rank_methods grid_s1 --words 12 [--first 1]
//
// The method of the paper with modes and widths that all controls share, and of each control alone:
//
//     build/release/bin/rank_methods grid_s1 --per-control
//
// The speed of the motion by articulator:
//
//     build/release/bin/rank_methods grid_s1 --velocity [--others grid_others] [--sharpness 0]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "dam/corpus/corpus.h"
#include "dam/evaluation/evaluate.h"
#include "dam/evaluation/evaluate_bootstrap.h"
#include "dam/training/train.h"
#include "tests/bench/rank_controls.h"
#include "tests/bench/rank_variants.h"

namespace {

using namespace animeme;  // NOLINT: a program
using bench::steps;
using bench::Variant;
using bench::variants;

using Sentences = std::vector<dam::Utterance>;

/// Of all that is scored.
dam::SynthesisOptions g_speaking;

[[noreturn]] void stop(const Error& error) {
  std::fprintf(stderr, "rank_methods: %s\n", error.describe().c_str());
  std::exit(3);
}

template <class T>
T need(Result<T> result) {
  if (!result) stop(result.error());
  return std::move(*result);
}

Result<dam::Evaluation> score(const dam::Model& model, std::span<const dam::Utterance> rows,
                              dam::SeenContexts seen = {}) {
  dam::EvaluateOptions options;
  options.synthesis = g_speaking;
  options.score.seen = std::move(seen);
  return dam::evaluate(model, rows, options);
}

dam::Corpus read(const std::string& folder, const std::string& controls) {
  dam::CorpusOptions options;
  options.controls_folder = controls;
  options.skip_missing = true;
  return need(dam::read_corpus(folder, options));
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

int run(const std::string& folder, const std::string& others, const std::string& controls,
        std::span<const Variant> methods) {
  const dam::Corpus corpus = read(folder, controls);
  dam::Corpus other;
  if (!others.empty()) other = read(others, controls);
  const char* const columns[] = {"split", "heldout_word_split"};
  std::printf("| method");
  for (const char* column : columns)
    std::printf(
        " | `%s`: NRMSE / L2 / corr | relative to `dam` (95 %%) | gap RMSE / corr | "
        "P B M closed (false a minute)",
        column);
  std::printf(" | training, s%s |\n", others.empty() ? "" : " | other speakers: gap corr");
  std::printf("|---|---|---|---|---|---|---|---|---|---|%s\n", others.empty() ? "" : "---|");
  dam::Evaluation best[2];
  bool first = true;
  for (const Variant& variant : methods) {
    std::printf("| %s", variant.name.c_str());
    double seconds = 0;
    std::optional<dam::Model> model;
    for (std::size_t i = 0; i < 2; ++i) {
      dam::TrainSummary summary;
      const auto rows = dam::select(corpus, columns[i], "train");
      dam::Model trained = need(dam::train(rows, variant.options, &summary));
      if (i == 0) seconds = summary.seconds;
      const dam::Evaluation e = need(score(trained, dam::select(corpus, columns[i], "test")));
      if (first) best[i] = e;
      print_cells(e, best[i], first);
      if (i == 0) model = std::move(trained);
    }
    std::printf(" | %.1f", seconds);
    if (!others.empty())
      std::printf(" | %.3f", need(score(*model, other.utterances)).gap_correlation);
    std::printf(" |\n");
    std::fflush(stdout);
    first = false;
  }
  return 0;
}

// ---- single controls ----

constexpr const char* kColumns[] = {"split", "heldout_word_split"};

int run_per_control(const std::string& folder, const std::string& controls,
                    std::span<const Variant> methods) {
  const dam::Corpus corpus = read(folder, controls);
  std::printf("| method, without closures");
  for (const char* column : kColumns)
    std::printf(" | `%s`: shared | each control alone | more (95 %%)", column);
  std::printf(" |\n|---|---|---|---|---|---|---|\n");
  for (const Variant& variant : methods) {
    if (variant.options.method != dam::Method::dam_paper) continue;
    std::printf("| %s", variant.name.c_str());
    for (const char* column : kColumns) {
      const auto rows = dam::select(corpus, column, "train"),
                 test = dam::select(corpus, column, "test");
      dam::EvaluateOptions scoring;
      scoring.synthesis.closure = false;
      const dam::Model shared = need(dam::train(rows, variant.options));
      const dam::Evaluation a = need(dam::evaluate(shared, test, scoring));
      const dam::Evaluation b =
          need(bench::evaluate_per_control(shared, rows, test, variant.options, scoring));
      const dam::PairedDifference d = need(dam::paired_difference(b, a));
      std::printf(" | %.4f | %.4f | %+.1f %% (%+.1f to %+.1f)", a.nrmse, b.nrmse,
                  100 * d.nrmse.difference / a.nrmse, 100 * d.nrmse.low / a.nrmse,
                  100 * d.nrmse.high / a.nrmse);
      std::fflush(stdout);
    }
    std::printf(" |\n");
  }
  return 0;
}

int run_velocity(const std::string& folder, const std::string& others,
                 const std::string& controls) {
  const dam::Corpus corpus = read(folder, controls);
  std::printf("%s", bench::velocity_head().c_str());
  for (const char* column : kColumns) {
    const dam::Model model = need(dam::train(dam::select(corpus, column, "train")));
    const auto print = [&](const std::string& name, const Sentences& rows) {
      const dam::Evaluation e = need(score(model, rows));
      std::printf("%s", bench::velocity_row(name, e).c_str());
      std::fflush(stdout);
    };
    print(std::string("`") + column + "`", dam::select(corpus, column, "test"));
    if (!others.empty() && column == kColumns[0])
      print("other speakers", read(others, controls).utterances);
  }
  return 0;
}

// ---- cross validation ----

// ---- rules ----

/// A way of speaking, beside the plain one.
struct Rule {
  const char* name;
  dam::SynthesisOptions options;
};

std::vector<Rule> rules() {
  const auto with = [](bool closure, double sharpness, double articulation) {
    dam::SynthesisOptions options;
    options.closure = closure;
    options.sharpness = sharpness;
    options.articulation = articulation;
    return options;
  };
  return {{"none: as learned", with(false, 0, 0)},
          {"closure of P B M, F and V", with(true, 0, 0)},
          {"sharpness 1", with(false, 1, 0)},
          {"articulation 1: jaw by height, lips forward", with(false, 0, 1)},
          {"closure and sharpness: default of trained models", with(true, 1, 0)},
          {"all: default of the built-in model", with(true, 1, 1)}};
}

/// A row of the table, the difference to the first row in brackets.
void print_rule(const dam::Evaluation& e, const dam::Evaluation& plain) {
  std::printf(" | %.4f (%+.4f)", e.nrmse, e.nrmse - plain.nrmse);
  const auto cell = [&](const char* name) {
    for (std::size_t i = 0; i < e.measures.size(); ++i)
      if (e.measures[i].name == name)
        std::printf(" | %.3f (%+.3f)", e.measures[i].nrmse,
                    e.measures[i].nrmse - plain.measures[i].nrmse);
  };
  for (const char* name : {"inner_gap", "jaw", "width"}) cell(name);
  std::printf(" | %.3f (%+.3f)", e.gap_correlation, e.gap_correlation - plain.gap_correlation);
}

int run_rules(const std::string& folder, const std::string& others, const std::string& controls) {
  const dam::Corpus corpus = read(folder, controls);
  dam::Corpus other;
  if (!others.empty()) other = read(others, controls);
  const dam::Model model = need(dam::train(dam::select(corpus, "split", "train")));
  Sentences test = dam::select(corpus, "split", "test");
  for (const auto& [who, rows] :
       {std::pair{"the recorded speaker", &test}, std::pair{"others", &other.utterances}}) {
    if (rows->empty()) continue;
    std::printf(
        "| %s: rules | NRMSE | inner gap | jaw | width | gap correlation | after gain and offset "
        "|\n|---|---|---|---|---|---|---|\n",
        who);
    std::optional<dam::Evaluation> plain;
    for (const Rule& rule : rules()) {
      dam::EvaluateOptions options;
      options.synthesis = rule.options;
      const dam::Evaluation e = need(dam::evaluate(model, *rows, options));
      if (!plain) plain = e;
      std::printf("| %s", rule.name);
      print_rule(e, *plain);
      std::printf(" | %.4f (%+.4f) |\n", e.fitted_nrmse, e.fitted_nrmse - plain->fitted_nrmse);
    }
    std::printf("\n");
  }
  return 0;
}

// ---- cross validation ----

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
    sum += need(score(model, fold.test)).nrmse / double(folds.size());
  }
  return sum;
}

int run_steps(const std::string& folder, const std::string& controls) {
  dam::Corpus corpus = read(folder, controls);
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

// ---- little data ----

bool shorter(const Sentences& a, const Sentences& b) { return a.size() < b.size(); }

/// Rows in random order until they hold `seconds` of phones other than silence.
Sentences some_of(const Sentences& rows, double seconds, std::mt19937& random) {
  std::vector<std::size_t> order(rows.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  for (std::size_t i = order.size(); i-- > 1;) std::swap(order[i], order[random() % (i + 1)]);
  Sentences some;
  for (std::size_t i = 0; i < order.size() && seconds > 0; ++i) {
    some.push_back(rows[order[i]]);
    for (const dam::Phone& phone : some.back().script.phones)
      if (phone.label != dam::kSilence) seconds -= phone.duration();
  }
  return some;
}

int run_little(const std::string& folder, const std::string& controls, double seconds) {
  constexpr int kDraws = 5;
  const dam::Corpus corpus = read(folder, controls);
  const Sentences rows = dam::select(corpus, "split", "train");
  const Sentences test = dam::select(corpus, "split", "test");
  std::mt19937 random(1);
  std::vector<Sentences> draws;
  for (int d = 0; d < kDraws; ++d) draws.push_back(some_of(rows, seconds, random));
  std::printf(
      "| trained on %.0f s of speech (%zu to %zu sentences, %d draws) | NRMSE: mean | "
      "min | max |\n|---|---|---|---|\n",
      seconds, std::min_element(draws.begin(), draws.end(), shorter)->size(),
      std::max_element(draws.begin(), draws.end(), shorter)->size(), kDraws);
  for (const Variant& variant : variants()) {
    std::vector<double> nrmse;
    for (const Sentences& draw : draws)
      nrmse.push_back(need(score(need(dam::train(draw, variant.options)), test)).nrmse);
    const auto [least, most] = std::minmax_element(nrmse.begin(), nrmse.end());
    std::printf("| %s | %.3f | %.3f | %.3f |\n", variant.name.c_str(),
                std::accumulate(nrmse.begin(), nrmse.end(), 0.0) / kDraws, *least, *most);
    std::fflush(stdout);
  }
  return 0;
}

// ---- words never heard ----

constexpr std::size_t kWordsOut = 5;
constexpr double kLeastTraining = 0.3;  // of the rows

using Words = std::set<std::string>;

bool has_any(const dam::Utterance& row, const Words& words) {
  const auto own = words_of(row);
  return std::any_of(own.begin(), own.end(),
                     [&](const std::string& word) { return words.contains(word); });
}

/// Whether enough is left without these words, and every phone of the corpus in it.
bool can_do_without(const Sentences& rows, const Words& out) {
  std::set<std::string> all, left;
  std::size_t kept = 0;
  for (const dam::Utterance& row : rows) {
    const bool held = has_any(row, out);
    kept += held ? 0 : 1;
    for (const dam::Phone& phone : row.script.phones) {
      all.insert(phone.label);
      if (!held) left.insert(phone.label);
    }
  }
  return left == all && double(kept) >= kLeastTraining * double(rows.size());
}

/// Sets of words, dealt from a shuffled pack that is renewed when it is empty.
std::vector<Words> random_word_sets(const Sentences& rows, std::size_t count) {
  Words vocabulary;
  for (const dam::Utterance& row : rows) vocabulary.merge(words_of(row));
  std::mt19937 random(2);
  std::vector<std::string> pack;
  std::vector<Words> sets;
  while (sets.size() < count) {
    Words set;
    for (int tries = 0; tries < 200 && set.size() < kWordsOut; ++tries) {
      if (pack.empty()) {
        pack.assign(vocabulary.begin(), vocabulary.end());
        for (std::size_t i = pack.size(); i-- > 1;) std::swap(pack[i], pack[random() % (i + 1)]);
      }
      Words trial = set;
      trial.insert(pack.back());
      pack.pop_back();
      if (can_do_without(rows, trial)) set = std::move(trial);
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

/// Errors inside the words held out and of whole sentences, one a set.
struct WordScores {
  std::vector<double> unseen, all;
};

/// The mean of `a` less that of `b` in percent of that of `b`, over sets drawn with replacement:
/// as it is, and the ends of the interval that holds 95 % of 10000 draws.
std::string more_than(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr int kDraws = 10000;
  std::mt19937 random(1);
  const auto percent = [&](const auto& at) {
    double sum_a = 0, sum_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::size_t set = at(i);
      sum_a += a[set];
      sum_b += b[set];
    }
    return 100 * (sum_a / sum_b - 1);
  };
  std::vector<double> draws;
  for (int d = 0; d < kDraws; ++d)
    draws.push_back(percent([&](std::size_t) { return random() % a.size(); }));
  std::sort(draws.begin(), draws.end());
  char text[64];
  std::snprintf(text, sizeof text, "%+.1f %% (%+.1f to %+.1f)",
                percent([](std::size_t i) { return i; }), draws[kDraws / 40],
                draws[kDraws - 1 - kDraws / 40]);
  return text;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

int run_words(const std::string& folder, const std::string& controls, std::size_t count,
              std::span<const Variant> methods) {
  const Sentences rows = read(folder, controls).utterances;
  const auto sets = random_word_sets(rows, count);
  std::vector<Fold> folds;
  for (const Words& set : sets) {
    folds.push_back(fold_of(rows, [&](std::size_t i) { return has_any(rows[i], set); }));
    std::printf("%zu / %zu:", folds.back().train.size(), folds.back().test.size());
    for (const std::string& word : set) std::printf(" %s", word.c_str());
    std::printf("\n");
  }
  std::printf(
      "\n| method | inside words held out: mean NRMSE | min | max | relative to `dam` (95 %%) "
      "| "
      "whole sentences with such words | relative to `dam` (95 %%) "
      "|\n|---|---|---|---|---|---|---|\n");
  std::optional<WordScores> first;
  for (const Variant& variant : methods) {
    WordScores scores;
    for (const Fold& fold : folds) {
      const dam::Model model = need(dam::train(fold.train, variant.options));
      const dam::Evaluation e = need(score(model, fold.test, dam::seen_contexts(fold.train)));
      scores.unseen.push_back(e.breakdown.words[1].nrmse);
      scores.all.push_back(e.nrmse);
    }
    const auto [least, most] = std::minmax_element(scores.unseen.begin(), scores.unseen.end());
    std::printf("| %s | %.4f | %.3f | %.3f | %s | %.4f | %s |\n", variant.name.c_str(),
                mean(scores.unseen), *least, *most,
                first ? more_than(scores.unseen, first->unseen).c_str() : "", mean(scores.all),
                first ? more_than(scores.all, first->all).c_str() : "");
    std::fflush(stdout);
    if (!first) first = std::move(scores);
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
  bool only_rules = false;
  app.add_flag("--rules", only_rules,
               "What closure, sharpness and articulation cost, on test rows and on --others");
  double little = 0;
  app.add_option("--little", little, "Seconds of speech to train on: little data, five draws")
      ->check(CLI::PositiveNumber);
  std::size_t words = 0;
  app.add_option("--words", words,
                 "Sets of five words to hold out: frames inside words never heard")
      ->check(CLI::Range(2, 1000));
  bool per_control = false, velocity = false;
  app.add_flag("--per-control", per_control,
               "Method of the paper: shared modes and widths, and those of each control alone");
  app.add_flag("--velocity", velocity, "Speed of the motion of dam by articulator");
  std::size_t first = 100;
  app.add_option("--first", first, "Only so many methods, from the top of the table")
      ->check(CLI::PositiveNumber);
  app.add_option("--sharpness", g_speaking.sharpness, "As of speak; method dam")
      ->check(CLI::Range(0.0, dam::kMostSharpness));
  CLI11_PARSE(app, argc, argv);
  const std::vector<Variant> all = variants();
  const auto methods = std::span(all).first(std::min(first, all.size()));
  if (per_control) return run_per_control(folder, controls, methods);
  if (velocity) return run_velocity(folder, others, controls);
  if (words > 0) return run_words(folder, controls, words, methods);
  if (only_rules) return run_rules(folder, others, controls);
  if (little > 0) return run_little(folder, controls, little);
  return only_steps ? run_steps(folder, controls) : run(folder, others, controls, methods);
}
