#include "tools/app/commands/corpus.h"

#include <cmath>
#include <cstdlib>

#include "dam/corpus/glitches.h"
#include "dam/signal/fap_signal.h"
#include "dam/training/alignment.h"
#include "tools/app/commands/fap_names.h"
#include "tools/app/commands/options.h"
#include "tools/formats/common/text.h"
#include "tools/formats/inspect/left_out.h"

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
  options.shard = settings.shard;
  options.shards = settings.shards;
  return options;
}

void say_left_out(const dam::LeftOut& left_out) {
  if (left_out.skipped > 0)
    say(std::to_string(left_out.skipped) + " rows without curves were skipped");
  for (const std::string& text : inspect::blanks_text(left_out)) warn(text);
}

double milliseconds_of(const std::string& lag) {
  return lag.empty() ? 0 : std::strtod(lag.c_str(), nullptr);
}

// The motion after the sound, in seconds, as far as it is sure; 0: it is not, which was said.
Result<double> find_lag(const std::vector<dam::Utterance>& sentences) {
  std::vector<const dam::Utterance*> given;
  for (const dam::Utterance& u : sentences) given.push_back(&u);
  const Result<dam::Alignment> alignment =
      dam::check_alignment(dam::remove_glitches(given).sentences);
  if (!alignment) return alignment.error();
  if (!alignment->lag || alignment->unrelated) {
    warn(
        "the lag between sound and motion cannot be estimated from these sentences; nothing is "
        "shifted");
    return 0.0;
  }
  if (alignment->lag->notable()) return alignment->lag->seconds;
  say(format("sound and motion are in sync (%+.0f ms); nothing is shifted",
             1000 * alignment->lag->seconds));
  return 0.0;
}

Result<void> shift_scripts(const std::string& lag, std::vector<dam::Utterance>& sentences) {
  if (lag.empty()) return {};
  Result<double> seconds = milliseconds_of(lag) / 1000;
  if (lag == "auto") seconds = find_lag(sentences);
  if (!seconds) return seconds.error();
  if (*seconds == 0) return {};
  for (dam::Utterance& u : sentences) u.script = dam::shifted_script(u.script, *seconds);
  say(format("scripts were shifted by %+.0f ms", 1000 * *seconds));
  return {};
}

}  // namespace

void add_lag_option(OptionTable& cli, CorpusSettings& settings) {
  cli.add("--lag", settings.lag,
          "Delay of the motion after the sound in ms (negative: before), by which scripts "
          "are shifted; auto: estimated")
      ->check([](const std::string& text) -> std::string {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        const bool number = !text.empty() && *end == 0 && std::abs(value) <= 1000;
        return text == "auto" || number ? ""
                                        : "neither auto nor a number of ms up to 1000: " + text;
      })
      ->value("MS|auto");
}

void add_corpus_options(OptionTable& cli, CorpusSettings& settings) {
  cli.add("--split-column", settings.split_column, "Column of utterances.tsv for --split")
      ->show_default();
  cli.add("--controls-folder", settings.controls_folder,
          "Folder of the corpus with the curves, ID.csv or ID.fap")
      ->show_default();
  cli.add("--skip-missing", settings.skip_missing, "Skip rows without curves instead of failing");
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
  if (!corpus) return corpus;
  say_left_out(corpus->left_out);
  if (auto done = shift_scripts(settings.lag, corpus->utterances); !done) return done.error();
  return corpus;
}

Result<dam::LeftOut> visit_corpus(const CorpusSettings& settings,
                                  const dam::SentenceVisitor& visit) {
  const Result<dam::CorpusOptions> options = corpus_options(settings);
  if (!options) return options.error();
  const double lag = milliseconds_of(settings.lag) / 1000;
  Result<dam::LeftOut> left_out = dam::visit_corpus(
      settings.folder, *options, [&](dam::Utterance sentence, std::size_t row, std::size_t rows) {
        if (lag != 0) sentence.script = dam::shifted_script(sentence.script, lag);
        return visit(std::move(sentence), row, rows);
      });
  if (left_out) say_left_out(*left_out);
  return left_out;
}

}  // namespace animeme::tools
