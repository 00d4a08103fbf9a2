#include "dam/evaluation/evaluate.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "tools/app/commands/evaluate_options.h"
#include "tools/app/commands/evaluate_speakers.h"
#include "tools/app/commands/face_stream.h"
#include "tools/app/commands/page_sound.h"
#include "tools/app/commands/train_base.h"
#include "tools/formats/common/text.h"
#include "tools/formats/inspect/cross_validation.h"
#include "tools/formats/inspect/evaluation.h"
#include "tools/formats/inspect/left_out.h"
#include "tools/speech/talking/spoken.h"
#include "tools/view/plot/curves.h"
#include "tools/view/plot/sentences.h"
#include "tools/view/sheet/sheet.h"
#include "tools/view/studio/head_store.h"

namespace animeme::tools {

namespace {

// A model; a folder of tracks (ID.csv or ID.fap); or models of a cross-validation.
struct System {
  std::string path;
  std::optional<dam::Model> model;  // none: tracks or folds
  std::optional<inspect::CrossValidation> folds = std::nullopt;
  std::optional<dam::Model> base = std::nullopt;  // of the folds
};

// A model file or "builtin"; a folder of tracks if it is one or `tracks` says so.
Result<System> open_system(const std::string& path, bool tracks) {
  std::error_code ignored;
  if (tracks || std::filesystem::is_directory(path, ignored)) return System{path, std::nullopt};
  Result<dam::Model> model = speech::read_model(path);
  if (!model) return model.error();
  return System{path, std::move(*model)};
}

// Models by cross validation.
Result<System> open_folds(const EvaluateOptions& options) {
  inspect::CrossValidation folds;
  folds.folds = std::size_t(options.folds);
  folds.train.method = *dam::find_method(options.method);
  System system{std::to_string(options.folds) + " folds of " + options.method, std::nullopt, folds};
  if (options.base.empty()) return system;
  Result<dam::Model> base = load_base(options.base, options.corpus, folds.train);
  if (!base) return base.error();
  system.path += " on " + options.base;
  system.base = std::move(*base);
  return system;
}

Result<std::vector<dam::SentencePair>> pairs_of_folds(const System& system,
                                                      const std::vector<dam::Utterance>& recorded,
                                                      const dam::EvaluateOptions& options) {
  inspect::CrossValidation folds = *system.folds;
  folds.base = system.base ? &*system.base : nullptr;
  folds.evaluate = options;
  ProgressLine line("training");
  folds.progress = [&](double done) {
    line.update(done);
    return true;
  };
  return inspect::cross_validate(recorded, folds);
}

// The sentences with what the system makes of them.
Result<std::vector<dam::SentencePair>> pairs_of(const System& system, const CorpusSettings& corpus,
                                                const std::vector<dam::Utterance>& recorded,
                                                const dam::EvaluateOptions& options) {
  if (system.model) return dam::synthesise_pairs(*system.model, recorded, options);
  if (system.folds) return pairs_of_folds(system, recorded, options);
  CorpusSettings settings = corpus;
  settings.lag.clear();
  settings.controls.clear();
  settings.controls_folder = std::filesystem::absolute(system.path).string();
  Result<dam::Corpus> tracks = read_corpus(settings);
  if (!tracks) return tracks.error();
  auto pairs = inspect::pair_up(std::move(tracks->utterances), recorded, corpus.skip_missing);
  if (!pairs) return pairs.error().in_file(system.path);
  return pairs;
}

Result<std::vector<dam::Control>> scale_of(const System& system,
                                           const std::vector<dam::SentencePair>& pairs) {
  if (system.model) return system.model->controls;
  Result<std::vector<dam::Control>> scale = inspect::scale_of(pairs);
  if (!scale) return scale.error().in_file(system.path);
  return scale;
}

// The recordings with the controls of the model; with all for tracks.
Result<dam::Corpus> read_recordings(const CorpusSettings& corpus, const System& system) {
  CorpusSettings settings = corpus;
  if (!system.folds) settings.controls.clear();
  if (system.model) {
    for (const dam::Control& control : system.model->controls) {
      settings.controls.push_back(control.name);
    }
  }
  return read_corpus(settings);
}

Result<dam::SeenContexts> read_seen(const EvaluateOptions& options, const CorpusSettings& corpus) {
  if (options.seen_split.empty()) return dam::SeenContexts();
  CorpusSettings settings = corpus;
  settings.split = options.seen_split;
  settings.lag.clear();
  settings.skip_missing = true;
  Result<dam::Corpus> read = read_corpus(settings);
  if (!read) return read.error();
  return dam::seen_contexts(read->utterances);
}

// The controls of both, measured as those of the first system.
std::vector<dam::Control> common_scale(const std::vector<dam::Control>& a,
                                       const std::vector<dam::SentencePair>& b) {
  std::vector<dam::Control> common;
  for (const dam::Control& control : a) {
    const auto& names = b[0].synthesised.names;
    if (std::find(names.begin(), names.end(), control.name) != names.end()) {
      common.push_back(control);
    }
  }
  return common;
}

Result<void> compare_systems(const EvaluateOptions& options, const CorpusSettings& corpus,
                             const std::vector<dam::SentencePair>& pairs,
                             const dam::EvaluateOptions& evaluate,
                             inspect::EvaluationReport& report) {
  Result<System> other = open_system(options.against, false);
  if (!other) return other.error();
  std::vector<dam::Utterance> recorded;
  for (const dam::SentencePair& pair : pairs) recorded.push_back(pair.recorded);
  Result<std::vector<dam::SentencePair>> others = pairs_of(*other, corpus, recorded, evaluate);
  if (!others) return others.error();
  dam::ScoreOptions scoring = evaluate.score;
  scoring.scale = common_scale(evaluate.score.scale, *others);
  if (scoring.scale.empty()) {
    return make_error(Code::not_found, "it has no control that the first system has")
        .in_file(options.against);
  }
  Result<dam::Evaluation> a = dam::score(pairs, scoring);
  if (!a) return a.error();
  Result<dam::Evaluation> b = dam::score(*others, scoring);
  if (!b) return b.error();
  dam::BootstrapOptions bootstrap;
  bootstrap.draws = options.draws;
  Result<dam::PairedDifference> difference = dam::paired_difference(*a, *b, bootstrap);
  if (!difference) return difference.error();
  report.against = options.against;
  report.difference = *difference;
  report.compared_controls = a->per_utterance[0].sums.squared.size();
  return {};
}

bool has_gap(const dam::Evaluation& result) {
  return std::any_of(result.measures.begin(), result.measures.end(),
                     [](const dam::SeriesScore& one) { return one.name == "inner_gap"; });
}

// Checks the thresholds; each is off below 0. A measure without a value fails.
std::vector<std::string> failed_checks(const EvaluateOptions& options,
                                       const dam::Evaluation& result) {
  std::vector<std::string> failed;
  const auto fail = [&](const char* pattern, double value, double limit) {
    failed.push_back(tools::format(pattern, value, limit));
  };
  if (options.max_nrmse >= 0 && !(result.nrmse <= options.max_nrmse)) {
    fail("the mean NRMSE is %.4f, above %g", result.nrmse, options.max_nrmse);
  }
  if (options.min_closed >= 0 && result.closure.phones == 0) {
    failed.emplace_back("there is no P B M whose closure could be told, or no FAP 4 and 5");
  } else if (100 * result.closure.predicted < options.min_closed) {
    fail("%.2f %% of P B M are closed, below %g %%", 100 * result.closure.predicted,
         options.min_closed);
  }
  if (options.max_false >= 0 && !has_gap(result)) {
    failed.emplace_back("false closures cannot be told without FAP 4 and 5");
  } else if (options.max_false >= 0 && result.closure.false_per_minute > options.max_false) {
    fail("there are %.2f false closures a minute, above %g", result.closure.false_per_minute,
         options.max_false);
  }
  return failed;
}

// The recorded voice of a sentence, if the corpus has it.
std::optional<viewer::Sound> sound_of(const CorpusSettings& corpus, const std::string& id) {
  for (const char* ending : {".wav", ".flac", ".mp3", ".m4a", ".ogg"}) {
    const auto path = std::filesystem::path(corpus.folder) / "audio" / (id + ending);
    std::error_code none;
    if (!std::filesystem::is_regular_file(path, none)) continue;
    Result<PageSound> sound = page_sound(path.string(), {});
    if (sound) return std::move(sound->sound);
    warn(sound.error().describe());
  }
  return std::nullopt;
}

Result<void> write_sheet(const std::string& output, const CorpusSettings& corpus,
                         const System& system, const std::vector<dam::SentencePair>& pairs,
                         const dam::Evaluation& evaluation) {
  const Result<head::Head> face = studio::ready_head("woman");
  if (!face) return face.error();
  const head::Rig rig = head::make_rig(*face);
  sheet::Sheet sheet;
  sheet.title = std::filesystem::path(system.path).filename().string();
  sheet.corpus = std::filesystem::path(corpus.folder).filename().string() +
                 (corpus.split.empty() ? "" : ", " + corpus.split_column + " " + corpus.split);
  sheet.model = system.model ? &*system.model : nullptr;
  sheet.pairs = &pairs;
  sheet.evaluation = &evaluation;
  sheet.head = &*face;
  sheet.rig = &rig;
  sheet.sound = [&](const std::string& id) { return sound_of(corpus, id); };
  const Result<std::string> html = sheet::make_sheet(sheet);
  if (!html) return html.error();
  if (auto done = write_file(output, *html); !done) return done.error();
  say(output + tools::format(": %.1f MB, open it in a browser", double(html->size()) / 1e6));
  return {};
}

Result<inspect::EvaluationReport> evaluate_all(const EvaluateOptions& options,
                                               const CorpusSettings& corpus,
                                               const std::string& path) {
  Result<System> system =
      options.folds > 0 ? open_folds(options) : open_system(path, !options.tracks.empty());
  if (!system) return system.error();
  Result<dam::Corpus> recorded = read_recordings(corpus, *system);
  if (!recorded) return recorded.error();
  dam::EvaluateOptions evaluate = options.evaluate;
  evaluate.synthesis.closure = !options.no_closure;
  Result<dam::SeenContexts> seen = read_seen(options, corpus);
  if (!seen) return seen.error();
  evaluate.score.seen = std::move(*seen);
  auto pairs = pairs_of(*system, corpus, recorded->utterances, evaluate);
  if (!pairs) return pairs.error().in_file(corpus.folder);
  inspect::EvaluationReport report;
  report.left_out = std::move(recorded->left_out);
  report.glitches = inspect::leave_out_glitches(*pairs);
  for (const std::string& text : inspect::glitches_text(report.glitches)) warn(text);
  auto scale = scale_of(*system, *pairs);
  if (!scale) return scale.error();
  evaluate.score.scale = std::move(*scale);
  Result<dam::Evaluation> result = dam::score(*pairs, evaluate.score);
  if (!result) return result.error().in_file(corpus.folder);
  report.system = system->path;
  report.closed_gap = evaluate.score.closed_gap;
  report.evaluation = std::move(*result);
  if (options.rules && system->model) {
    auto rules = inspect::rule_costs(*system->model, recorded->utterances, evaluate.score);
    if (!rules) return rules.error().in_file(corpus.folder);
    report.rules = std::move(*rules);
  }
  if (!options.against.empty()) {
    auto done = compare_systems(options, corpus, *pairs, evaluate, report);
    if (!done) return done.error();
  }
  if (options.codec) {
    ProgressLine line("coding");
    auto codec = inspect::score_codec(*pairs, encode_options(options.stream), evaluate.score,
                                      [&](double done) { line.update(done); });
    if (!codec) return codec.error();
    report.codec = std::move(*codec);
  }
  if (!options.picture.empty()) {
    const Result<std::string> svg = plot::sentences_svg(*pairs, report.evaluation);
    if (!svg) return svg.error();
    const auto drawing = plot::drawing_bytes(options.picture, *svg);
    if (!drawing) return drawing.error();
    if (auto done = write_file(options.picture, *drawing); !done) return done.error();
  }
  if (!options.report.empty()) {
    if (auto done = write_sheet(options.report, corpus, *system, *pairs, report.evaluation);
        !done) {
      return done.error();
    }
  }
  return report;
}

}  // namespace

Result<int> run(const EvaluateOptions& options) {
  if (!options.speakers.empty()) return run_speakers(options);
  CorpusSettings corpus = options.corpus;
  std::string path = options.system;
  if (options.folds > 0 && !options.tracks.empty())
    return usage_error("--folds and --tracks are two systems; give one of them");
  if (options.folds == 0 && (!options.base.empty() || !options.controls.empty()))
    return usage_error("--base and --controls belong to --folds; a model has its own");
  if (!options.base.empty() && options.method != "dam")
    return usage_error("--base is for --method dam");
  if (!options.tracks.empty() && corpus.folder.empty()) {
    corpus.folder = options.system;
    path = options.tracks;
  } else if (options.folds > 0 && corpus.folder.empty()) {
    corpus.folder = options.system;
    corpus.controls = options.controls;
    path.clear();
  } else if (options.folds > 0) {
    return usage_error("--folds trains its own models: evaluate --folds N CORPUS");
  } else if (!options.tracks.empty()) {
    return usage_error("--tracks takes the place of the model: evaluate --tracks DIR CORPUS");
  }
  if (corpus.folder.empty()) return usage_error("name a model and a corpus folder");
  Result<inspect::EvaluationReport> report = evaluate_all(options, corpus, path);
  if (!report) return report.error();
  std::fputs(options.json ? (inspect::evaluation_json(*report) + "\n").c_str()
                          : inspect::evaluation_text(*report, options.full).c_str(),
             stdout);
  const std::vector<std::string> failed = failed_checks(options, report->evaluation);
  for (const std::string& sentence : failed) {
    std::fprintf(stderr, "animeme: check failed: %s\n", sentence.c_str());
  }
  return failed.empty() ? kOk : kCheckFailed;
}

const Command kEvaluate{
    "evaluate", "Measure the error of synthesis against recorded motion",
    "  animeme evaluate builtin grid_s1 --split test --seen-split train --picture curves.svg\n"
    "  animeme evaluate a.dam grid_s1 --split test --against b.dam\n"
    "  animeme evaluate me.dam my_corpus --split test --report me.html\n"
    "  animeme evaluate --folds 5 my_corpus\n"
    "  animeme evaluate builtin grid_others --speakers grid_s1 --split test\n"
    "  animeme evaluate --tracks theirs grid_s1 --split test --json\n"
    "  animeme evaluate a.dam grid_s1 --split test --codec --kbps 2 --max-nrmse 0.6",
    set_up<EvaluateOptions>};

}  // namespace animeme::tools
