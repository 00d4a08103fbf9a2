#include "tools/app/commands/spoken_options.h"

#include "tools/app/commands/options.h"
#include "tools/app/commands/script_options.h"
#include "tools/app/commands/text_or_file.h"
#include "tools/formats/common/text.h"

namespace animeme::tools {

void add_spoken_options(OptionTable& cli, speech::SpokenOptions& options) {
  cli.add("--text", options.text, "Text to speak with a synthetic voice, plain or SSML")
      ->value("TEXT")
      ->sets(options.has_text);
  cli.add("--text-file", options.text_file, "Read the text from a file, - for standard input")
      ->value("FILE")
      ->excludes("--text");
  cli.add("--script", options.script,
          "Timed phones or words: TextGrid, labels, subtitles, output of speech services")
      ->value("FILE")
      ->excludes("--text --text-file");
  add_script_options(cli, options.script_reading);
  cli.add("--audio", options.audio,
          options.listen ? "Recorded voice in any format that FFmpeg reads; without a transcript, "
                           "phones are recognised"
                         : "Recorded voice in any format that FFmpeg reads")
      ->value("FILE")
      ->excludes("--text --text-file");
  cli.add("--transcript", options.transcript,
          "Text that is spoken in --audio; its phones are found by forced alignment")
      ->check(problem_with_transcript)
      ->sets(options.has_transcript)
      ->needs("--audio")
      ->excludes("--script");
  cli.add("--lang", options.language,
          "Language of the text: en, de, pt-br; zh+en: a second language, chosen by its "
          "script; auto: detected; en+f3: a voice variant")
      ->show_default();
  cli.add("--tts", options.tts,
          "External TTS command: a program that reads the text from standard input or "
          "{text}, writes sound to {wav} and optionally timed phones to {script} (see "
          "tools/speech/talking/README.md)")
      ->value("COMMAND")
      ->excludes("--script --audio");
  cli.add("--max-seconds", options.most_seconds, "Longest script")
      ->value("SECONDS=3600")
      ->between(1.0, dam::kMaxScriptSeconds)
      ->show_default();
  cli.add("--speed", options.words_per_minute, "Words per minute of the synthetic voice")
      ->value("80..450=175")
      ->between(80, 450)
      ->show_default();
  cli.add("--pitch", options.pitch, "Pitch of the synthetic voice")
      ->value("0..100=50")
      ->between(0, 100)
      ->show_default();
}

std::string missing_options(const speech::SpokenOptions& options) {
  const dam::ScriptOptions& reading = options.script_reading;
  if (options.script.empty() && options.tts.empty() &&
      !(reading.tier.empty() && reading.format.empty() && reading.speaker.empty())) {
    return "--tier, --speaker and --script-format are for --script, and for the timed phones of "
           "--tts";
  }
  if (options.has_transcript && options.audio.empty()) return "--transcript requires --audio";
  if (has_source(options)) return {};
  return options.audio.empty()
             ? "nothing to say: give a text, --script, or --audio with --transcript"
             : "--audio needs --transcript (its text) or --script (its timed phones)";
}

Result<void> check_words(const voice::Alignment& alignment, double least) {
  std::string list;
  for (const voice::AlignedWord& word : alignment.words) {
    if (!word.known || word.confidence >= least) continue;
    list += (list.empty() ? "" : ", ") + word.text +
            format(" (%.2f s, %.2f)", word.start, word.confidence);
  }
  if (list.empty()) return {};
  return make_error(Code::out_of_range, "words below --min-confidence: " + list);
}

}  // namespace animeme::tools
