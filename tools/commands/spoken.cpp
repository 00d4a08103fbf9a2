#include "tools/commands/spoken.h"

#include <CLI/CLI.hpp>

#include "tools/commands/common.h"
#include "tools/commands/voice_input.h"
#include "tools/voice/align.h"
#include "tools/voice/voice.h"

namespace animeme::tools {

namespace {

Result<Spoken> speak(const SpokenOptions& options, const std::string& text) {
  voice::VoiceOptions settings;
  settings.language = options.language;
  settings.words_per_minute = options.words_per_minute;
  settings.pitch = options.pitch;
  Result<voice::Speech> speech = voice::speak_text(text, settings);
  if (!speech) return speech.error();
  return Spoken{std::move(speech->script), std::move(speech->audio), speech->voice};
}

Result<Spoken> follow_script(const SpokenOptions& options) {
  Result<dam::Script> script = read_script(options.script);
  if (!script) return script.error();
  Spoken spoken{std::move(*script), std::nullopt, {}};
  if (options.audio.empty()) return spoken;
  Result<media::Pcm> audio = read_voice(options.audio);
  if (!audio) return audio.error();
  if (auto ok = dam::check_against_audio(spoken.script, audio->duration()); !ok) {
    return ok.error().in_file(options.script);
  }
  spoken.audio = std::move(*audio);
  return spoken;
}

Result<Spoken> align_voice(const SpokenOptions& options) {
  Result<dam::Script> script = align_file(options.audio, options.transcript, options.language);
  if (!script) return script.error();
  Result<media::Pcm> audio = read_voice(options.audio);
  if (!audio) return audio.error();
  return Spoken{std::move(*script), std::move(*audio), {}};
}

}  // namespace

void add_spoken_options(CLI::App& app, SpokenOptions& options) {
  app.add_option("--text", options.text, "Text to speak with a synthetic voice")
      ->each([&options](const std::string&) { options.has_text = true; });
  app.add_option("--text-file", options.text_file, "The same from a file, - for standard input")
      ->excludes("--text");
  app.add_option("--script", options.script,
                 "Timed phones of a recording: TSV (start_s end_s phone) or Praat TextGrid")
      ->excludes("--text")
      ->excludes("--text-file");
  app.add_option("--audio", options.audio, "Recorded voice in any format that FFmpeg reads")
      ->excludes("--text")
      ->excludes("--text-file");
  app.add_option("--transcript", options.transcript,
                 "What is said in --audio; its phones are found by alignment")
      ->each([&options](const std::string&) { options.has_transcript = true; })
      ->needs("--audio")
      ->excludes("--script");
  app.add_option("--lang", options.language, "Language of the text: en, de, fr, pt-br ...")
      ->capture_default_str();
  app.add_option("--speed", options.words_per_minute, "Words a minute of the synthetic voice")
      ->check(CLI::Range(80, 450))
      ->capture_default_str();
  app.add_option("--pitch", options.pitch, "Pitch of the synthetic voice")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
}

Result<dam::Script> align_file(const std::string& audio, const std::string& transcript,
                               const std::string& language) {
  Result<media::Pcm> pcm = read_voice(audio, voice::kAlignRate);
  if (!pcm) return pcm.error();
  voice::AlignOptions settings;
  settings.language = language;
  Result<voice::Alignment> alignment = voice::align(*pcm, transcript, settings);
  if (!alignment) return alignment.error().in_file(audio);
  for (const std::string& text : alignment->warnings) warn(audio + ": " + text);
  return std::move(alignment->script);
}

std::string missing_options(const SpokenOptions& options) {
  const bool source = options.has_text || !options.text_file.empty() || !options.script.empty() ||
                      options.has_transcript;
  if (source) return {};
  return options.audio.empty()
             ? "nothing to say: give --text, --script, or --audio with --transcript"
             : "--audio needs --transcript (its text) or --script (its timed phones)";
}

Result<Spoken> get_spoken(const SpokenOptions& options) {
  if (!options.text_file.empty()) {
    Result<std::string> text = read_text_file(options.text_file);
    if (!text) return text.error();
    Result<Spoken> spoken = speak(options, *text);
    if (!spoken) return spoken.error().in_file(options.text_file);
    return spoken;
  }
  if (options.has_text) return speak(options, options.text);
  if (!options.script.empty()) return follow_script(options);
  return align_voice(options);
}

}  // namespace animeme::tools
