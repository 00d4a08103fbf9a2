#include "tools/app/commands/spoken_options.h"
#include "tools/app/commands/bounds.h"

#include <CLI/CLI.hpp>

#include "tools/app/commands/script_options.h"

namespace animeme::tools {

void add_spoken_options(CLI::App& app, speech::SpokenOptions& options) {
  app.add_option("--text", options.text, "Text to speak with a synthetic voice, plain or SSML")
      ->option_text("TEXT")
      ->each([&options](const std::string&) { options.has_text = true; });
  app.add_option("--text-file", options.text_file, "The same from a file, - for standard input")
      ->option_text("FILE")
      ->excludes("--text");
  app.add_option("--script", options.script,
                 "Timed phones or words: TextGrid, labels, subtitles, what speech services give")
      ->option_text("FILE")
      ->excludes("--text")
      ->excludes("--text-file");
  add_script_options(app, options.script_reading);
  app.add_option("--audio", options.audio,
                 options.listen
                     ? "Recorded voice in any format that FFmpeg reads; alone, it is listened to"
                     : "Recorded voice in any format that FFmpeg reads")
      ->option_text("FILE")
      ->excludes("--text")
      ->excludes("--text-file");
  app.add_option("--transcript", options.transcript,
                 "What is said in --audio; its phones are found by alignment")
      ->each([&options](const std::string&) { options.has_transcript = true; })
      ->needs("--audio")
      ->excludes("--script");
  app.add_option(
         "--lang", options.language,
         "Language of the text: en, de, pt-br; zh+en: further ones by script; auto; en+f3: variant")
      ->capture_default_str();
  app.add_option("--tts", options.tts,
                 "Voice of yours for the text: a program that writes sound to {wav} and may write "
                 "times to {script}; it reads the text, which is also {text} (see "
                 "tools/speech/talking/README.md)")
      ->option_text("COMMAND")
      ->excludes("--script")
      ->excludes("--audio");
  app.add_option("--max-seconds", options.most_seconds, "Longest script that is spoken")
      ->option_text("SECONDS=3600")
      ->check(between(1.0, dam::kMaxScriptSeconds))
      ->capture_default_str();
  app.add_option("--speed", options.words_per_minute, "Words a minute of the synthetic voice")
      ->option_text("80..450=175")
      ->check(between(80, 450))
      ->capture_default_str();
  app.add_option("--pitch", options.pitch, "Pitch of the synthetic voice")
      ->option_text("0..100=50")
      ->check(between(0, 100))
      ->capture_default_str();
}

std::string missing_options(const speech::SpokenOptions& options) {
  const dam::ScriptOptions& reading = options.script_reading;
  if (options.script.empty() && options.tts.empty() &&
      !(reading.tier.empty() && reading.format.empty())) {
    return "--tier and --script-format say how a --script is read, or what a --tts tells";
  }
  if (has_source(options)) return {};
  return options.audio.empty()
             ? "nothing to say: give --text, --script, or --audio with --transcript"
             : "--audio needs --transcript (its text) or --script (its timed phones)";
}

}  // namespace animeme::tools
