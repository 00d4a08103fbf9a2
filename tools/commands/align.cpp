#include <CLI/CLI.hpp>

#include "dam/script/script.h"
#include "tools/commands/command.h"
#include "tools/commands/terminal.h"
#include "tools/files/files.h"
#include "tools/speech/spoken.h"

namespace animeme::tools {

namespace {

struct AlignOptions {
  std::string audio;
  std::string transcript;
  std::string language = "en";
  std::string output;
};

Result<int> run(const AlignOptions& options) {
  Result<dam::Script> script =
      speech::align_file(options.audio, options.transcript, options.language, talk());
  if (!script) return script.error();
  const std::string text = dam::write_script(*script, extension_of(options.output));
  if (auto written = write_file(options.output, text); !written) return written.error();
  say(name_of_output(options.output) + ": " + std::to_string(script->phones.size()) + " phones");
  return kOk;
}

void add_options(CLI::App& app, AlignOptions& options) {
  app.add_option("--audio", options.audio, "Recorded voice in any format that FFmpeg reads")
      ->required();
  app.add_option("--transcript", options.transcript, "What is said in it")->required();
  app.add_option("--lang", options.language, "Language of the transcript")->capture_default_str();
  add_output(
      app.add_option("-o,--output", options.output,
                     "Script to write: .TextGrid (Praat), .tsv, .pho (MBROLA), .vtt (WebVTT), - "
                     "for a TextGrid on standard output"),
      dam::script_endings(), OutputKind::file_or_dash)
      ->required();
}

}  // namespace

const Command kAlign{"align", "Find the timed phones of a recording from its text",
                     "  animeme align --audio voice.wav --transcript \"what she said\" "
                     "-o voice.TextGrid\n"
                     "  animeme align --audio voice.mp3 --transcript \"what she said\" -o - -q",
                     set_up<AlignOptions>};

}  // namespace animeme::tools
