#include "tools/commands/corpus.h"

#include <CLI/CLI.hpp>

#include "dam/signal/fap_signal.h"
#include "tools/commands/fap_names.h"

namespace animeme::tools {

namespace {

Result<dam::CorpusOptions> corpus_options(const CorpusSettings& settings) {
  Result<std::vector<std::string>> names = control_names(settings.controls);
  if (!names) return names.error();
  dam::CorpusOptions options;
  options.split_column = settings.split_column;
  options.split_value = settings.split;
  options.controls_folder = settings.controls_folder;
  options.controls = std::move(*names);
  options.skip_missing = settings.skip_missing;
  return options;
}

void say_skipped(std::size_t rows) {
  if (rows > 0) say(std::to_string(rows) + " rows without curves are left out");
}

}  // namespace

void add_corpus_options(CLI::App& app, CorpusSettings& settings) {
  app.add_option("--split-column", settings.split_column, "Column of utterances.tsv for --split")
      ->capture_default_str();
  app.add_option("--controls-folder", settings.controls_folder,
                 "Folder of the corpus with the curves, ID.csv or ID.fap")
      ->capture_default_str();
  app.add_flag("--skip-missing", settings.skip_missing,
               "Leave out rows that have no curves instead of stopping");
}

Result<std::vector<std::string>> control_names(const std::vector<std::string>& items) {
  std::vector<std::string> names;
  for (const std::string& item : items) {
    const std::size_t dash = item.find('-');
    const int first = fap_number(item.substr(0, dash));
    const int last = dash == std::string::npos ? first : fap_number(item.substr(dash + 1));
    if (first == 0 || last == 0) {
      names.push_back(item);
      continue;
    }
    if (last < first) {
      return make_error(Code::invalid_argument, "--controls " + item + " runs backwards");
    }
    for (int fap = first; fap <= last; ++fap) names.push_back(dam::fap_channel(fap));
  }
  return names;
}

Result<void> set_limits(const CorpusSettings& settings, dam::Model& model) {
  std::filesystem::path path = settings.limits;
  if (path.empty() && !settings.folder.empty()) {
    path = std::filesystem::path(settings.folder) / "limits.tsv";
    std::error_code none;
    if (!std::filesystem::exists(path, none)) return {};
  }
  if (path.empty()) return {};
  const Result<std::vector<std::uint8_t>> bytes = read_input(path.string());
  if (!bytes) return bytes.error();
  std::vector<std::string> names;
  for (const dam::Control& control : model.controls) names.push_back(control.name);
  auto limits =
      dam::read_limits({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, names);
  if (!limits) return std::move(limits).error().in_file(path.string());
  model.limits = std::move(*limits);
  return {};
}

Result<dam::Corpus> read_corpus(const CorpusSettings& settings) {
  const Result<dam::CorpusOptions> options = corpus_options(settings);
  if (!options) return options.error();
  Result<dam::Corpus> corpus = dam::read_corpus(settings.folder, *options);
  if (corpus) say_skipped(corpus->skipped);
  return corpus;
}

Result<std::size_t> visit_corpus(const CorpusSettings& settings,
                                 const dam::SentenceVisitor& visit) {
  const Result<dam::CorpusOptions> options = corpus_options(settings);
  if (!options) return options.error();
  Result<std::size_t> skipped = dam::visit_corpus(settings.folder, *options, visit);
  if (skipped) say_skipped(*skipped);
  return skipped;
}

}  // namespace animeme::tools
