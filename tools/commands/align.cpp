#include <CLI/CLI.hpp>
#include <cstdio>

#include "dam/script/script.h"
#include "tools/commands/command.h"
#include "tools/commands/script_options.h"
#include "tools/commands/terminal.h"
#include "tools/files/files.h"
#include "tools/json.h"
#include "tools/speech/spoken.h"

namespace animeme::tools {

namespace {

struct AlignOptions {
  std::string audio;
  std::string transcript;
  std::string script;
  dam::ScriptOptions reading;
  voice::AlignOptions aligner;
  std::optional<double> least;
  std::string output;
  bool json = false;
};

// The words that are less sure than they have to be.
Result<void> check_words(const voice::Alignment& alignment, double least) {
  std::string list;
  for (const voice::AlignedWord& word : alignment.words) {
    if (!word.known || word.confidence >= least) continue;
    char where[64];
    std::snprintf(where, sizeof where, " (%.2f s, %.2f)", word.start, word.confidence);
    list += (list.empty() ? "" : ", ") + word.text + where;
  }
  if (list.empty()) return {};
  return make_error(Code::out_of_range, "words below --min-confidence: " + list);
}

Json json_of_word(const voice::AlignedWord& word) {
  return {{"word", word.text},
          {"start", word.start},
          {"end", word.end},
          {"confidence", word.confidence},
          {"said", word.said}};
}

Json json_of_put_in(const voice::PutIn& one) {
  return {
      {"start", one.start}, {"end", one.end}, {"phones", one.phones}, {"before_word", one.before}};
}

Json phone_list(const voice::Alignment& alignment) {
  Json list = Json::array();
  for (std::size_t i = 0; i < alignment.script.phones.size(); ++i) {
    const dam::Phone& phone = alignment.script.phones[i];
    list.push_back({{"phone", phone.label},
                    {"start", phone.start},
                    {"end", phone.end},
                    {"word", phone.word},
                    {"confidence", alignment.confidences[i]}});
  }
  return list;
}

void print_json(const voice::Alignment& alignment) {
  const Json json = {{"phones", alignment.script.phones.size()},
                     {"confidence", alignment.confidence},
                     {"approximate", alignment.approximate},
                     {"warnings", alignment.warnings},
                     {"words", json_list(alignment.words, json_of_word)},
                     {"put_in", json_list(alignment.put_in, json_of_put_in)},
                     {"timed_phones", phone_list(alignment)}};
  std::printf("%s\n", pretty(json).c_str());
}

Result<int> run(const AlignOptions& options) {
  std::string transcript = options.transcript;
  if (!options.script.empty()) {
    auto words = speech::words_of_file(options.script, options.reading);
    if (!words) return words.error();
    transcript = std::move(*words);
  }
  voice::AlignOptions settings = options.aligner;
  if (options.least && *options.least == 0) settings.least_confidence = 0;
  const auto alignment = speech::align_file(options.audio, transcript, settings, talk());
  if (!alignment) return alignment.error();
  if (options.least) {
    if (auto sure = check_words(*alignment, *options.least); !sure) {
      return sure.error().in_file(options.audio);
    }
  }
  const dam::Script& script = alignment->script;
  const std::string text = dam::write_script(script, extension_of(options.output));
  if (auto written = write_file(options.output, text); !written) return written.error();
  if (options.json) print_json(*alignment);
  char sure[32];
  std::snprintf(sure, sizeof sure, "%.2f", alignment->confidence);
  say(name_of_output(options.output) + ": " + std::to_string(script.phones.size()) +
      " phones, confidence " + sure);
  return kOk;
}

void add_options(CLI::App& app, AlignOptions& options) {
  app.add_option("--audio", options.audio, "Recorded voice in any format that FFmpeg reads")
      ->required();
  auto* said = app.add_option_group("what is said");
  said->add_option("--transcript", options.transcript, "What is said in it");
  said->add_option("--script", options.script,
                   "The same as a script of words: subtitles, what a recogniser wrote; its times "
                   "are not used");
  said->require_option(1);
  add_script_options(app, options.reading);
  app.add_option("--lang", options.aligner.language,
                 "Language of the transcript, as en, it or es-419")
      ->capture_default_str();
  app.add_option("--min-confidence", options.least,
                 "Refuse words that are less sure, 0 to 1 (0.05: those that hardly fit), by name; "
                 "0: refuse nothing at all. Without it a recording is refused whose text does not "
                 "fit on the whole: another text, noise, nobody speaks")
      ->check(CLI::Range(0.0, 1.0));
  add_output(
      app.add_option("-o,--output", options.output,
                     "Script to write: .TextGrid (Praat), .tsv, .pho (MBROLA), .vtt (WebVTT), - "
                     "for a TextGrid on standard output"),
      dam::script_endings(), OutputKind::file_or_dash)
      ->required();
  app.add_flag(
      "--json", options.json,
      "On standard output: words with times, confidences and whether they are said; speech "
      "that the transcript does not have (put_in); each phone with its confidence");
}

}  // namespace

const Command kAlign{"align", "Find the timed phones of a recording from its text",
                     "  animeme align --audio voice.wav --transcript \"what she said\" "
                     "-o voice.TextGrid\n"
                     "  animeme align --audio voice.wav --script voice.srt --json -o voice.tsv",
                     set_up<AlignOptions>};

}  // namespace animeme::tools
