#include <cstdio>
#include <filesystem>

#include "dam/script/script.h"
#include "tools/app/commands/command.h"
#include "tools/app/commands/script_options.h"
#include "tools/app/commands/spoken_options.h"
#include "tools/app/commands/terminal.h"
#include "tools/app/commands/text_or_file.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/files.h"
#include "tools/formats/files/output_file.h"
#include "tools/speech/talking/marks.h"
#include "tools/speech/talking/spoken.h"
#include "tools/speech/talking/written_text.h"

namespace animeme::tools {

namespace {

struct AlignOptions {
  std::string audio;
  std::string transcript;
  bool has_transcript = false;  // it may be empty
  std::string script;
  dam::ScriptOptions reading;
  voice::AlignOptions aligner;
  std::optional<double> least;
  std::string output;
  bool json = false;
};

Json json_of_word(const voice::AlignedWord& word) {
  return {{"word", word.text},
          {"start", word.start},
          {"end", word.end},
          {"confidence", word.confidence},
          {"said", word.said}};
}

Json json_of_insertion(const voice::Insertion& one) {
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

void print_json(const voice::Alignment& alignment, bool heard) {
  const Json json = {{"phones", alignment.script.phones.size()},
                     {"confidence", alignment.confidence},
                     {"approximate", alignment.approximate},
                     {"heard", heard},
                     {"warnings", alignment.warnings},
                     {"words", json_list(alignment.words, json_of_word)},
                     {"inserted", json_list(alignment.inserted, json_of_insertion)},
                     {"timed_phones", phone_list(alignment)}};
  std::printf("%s\n", pretty(json).c_str());
}

// Of the text that there is.
Result<voice::Alignment> align_to_text(const AlignOptions& options) {
  std::string transcript =
      speech::text_to_say(options.transcript, options.reading.speak_marks, terminal_log());
  if (!options.script.empty()) {
    auto words = speech::words_of_file(options.script, options.reading);
    if (!words) return words.error();
    transcript = std::move(*words);
  }
  voice::AlignOptions settings = options.aligner;
  if (options.least && *options.least == 0) settings.least_confidence = 0;
  return speech::align_file(options.audio, transcript, settings, terminal_log());
}

// Of what is heard, where there is no text.
Result<voice::Alignment> align_by_ear(const AlignOptions& options) {
  ProgressLine progress("listening");
  voice::ListenOptions settings{.language = options.aligner.language};
  settings.progress = [&](double done) { progress.update(done); };
  auto heard = speech::listen_to_file(options.audio, settings, terminal_log());
  progress.clear();
  if (!heard) return heard.error();
  voice::Alignment alignment;
  std::string words;
  for (const voice::RecognisedWord& one : heard->words) {
    voice::AlignedWord& word = alignment.words.emplace_back();
    word.text = one.text;
    word.start = one.start;
    word.end = one.end;
    word.confidence = one.confidence;
    words += (words.empty() ? "" : " ") + one.text;
  }
  say(options.audio + ": recognised without its text" +
      (words.empty() ? "" : ": \"" + words + "\"") + "; --transcript is more accurate");
  alignment.script = std::move(heard->script);
  alignment.confidences = std::move(heard->confidences);
  alignment.confidence = heard->confidence;
  alignment.warnings = std::move(heard->warnings);
  return alignment;
}

// "voice.TextGrid" of "recordings/voice.wav", beside it.
std::string usual_output(const std::string& audio) {
  return std::filesystem::path(audio).replace_extension(".TextGrid").string();
}

Result<int> run(AlignOptions options) {
  if (options.output.empty()) {
    options.output = usual_output(options.audio);
    // Somebody may have corrected it by hand.
    std::error_code unknown;
    if (std::filesystem::exists(options.output, unknown)) {
      return usage_error(options.output + " exists already; -o " + options.output +
                         " replaces it, -o with another name keeps it");
    }
    if (auto can = try_output(options.output); !can) return can.error();
  }
  const bool told = options.has_transcript || !options.script.empty();
  const auto alignment = told ? align_to_text(options) : align_by_ear(options);
  if (!alignment) return alignment.error();
  if (options.least) {
    if (auto sure = check_words(*alignment, *options.least); !sure) {
      return sure.error().in_file(options.audio);
    }
  }
  const dam::Script& script = alignment->script;
  const auto& sure = alignment->confidences;
  const speech::Doubts doubts =
      told ? speech::doubts_of(sure, alignment->words) : speech::doubts_of(script, sure);
  const std::string lines =
      speech::write_marked_script(script, {}, extension_of(options.output), doubts);
  if (auto written = write_file(options.output, lines); !written) return written.error();
  if (options.json) print_json(*alignment, !told);
  say(name_of_output(options.output) + ": " + std::to_string(script.phones.size()) +
      format(" phones, confidence %.2f", alignment->confidence));
  return kOk;
}

void add_options(OptionTable& cli, AlignOptions& options) {
  cli.add("audio,--audio", options.audio, "Recorded voice in any format that FFmpeg reads")
      ->required();
  cli.add("--transcript", options.transcript,
          "Text that is spoken; without it and --script, phones are recognised")
      ->check(problem_with_transcript)
      ->sets(options.has_transcript);
  cli.add("--script", options.script,
          "The text as a script of words, such as subtitles or the output of a recogniser; "
          "its times are ignored")
      ->excludes("--transcript");
  add_script_options(cli, options.reading);
  cli.add("--lang", options.aligner.language,
          "Language of the transcript, such as en, it or es-419")
      ->show_default();
  cli.add("--min-confidence", options.least,
          "Fail if words have a lower confidence, 0 to 1 (0.05: words that hardly match), "
          "and name them; 0: accept everything. Default: fail if the text as a whole matches "
          "no better than wrong texts do (another text, noise, no speech)")
      ->between(0.0, 1.0);
  cli.add("-o,--output", options.output,
          "Script to write: .TextGrid (Praat, with confidences and doubtful parts), .tsv, .pho "
          "(MBROLA), .vtt (WebVTT), - for a "
          "TextGrid on standard output; default: the name of the recording with .TextGrid, "
          "unless that file exists")
      ->output(joined(dam::script_endings(), " "), OutputKind::file_or_dash);
  cli.add("--json", options.json,
          "Print words with times, confidences and whether they are spoken; speech that is "
          "not in the transcript (inserted); each phone with its confidence");
}

}  // namespace

const Command kAlign{
    "align", "Find the timed phones of a recording, with or without its text",
    "  animeme align voice.wav --transcript \"what she said\"  # writes voice.TextGrid\n"
    "  animeme align voice.wav -o heard.TextGrid  # without its text: less accurate\n"
    "  animeme align voice.wav --script voice.srt --json -o voice.tsv",
    set_up<AlignOptions>};

}  // namespace animeme::tools
