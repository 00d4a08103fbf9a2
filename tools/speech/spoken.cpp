#include "tools/speech/spoken.h"

#include "dam/model/builtin.h"
#include "tools/files/files.h"
#include "tools/speech/voice_file.h"
#include "tools/voice/align.h"
#include "tools/voice/voice.h"

namespace animeme::speech {

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

Result<Spoken> follow_script(const SpokenOptions& options, const tools::Talk& talk) {
  Result<dam::Script> script = read_script(
      options.script, {options.script_reading, options.language, options.most_seconds}, talk);
  if (!script) return script.error();
  Spoken spoken{std::move(*script), std::nullopt, {}};
  if (options.audio.empty()) return spoken;
  Result<media::Pcm> audio = read_voice(options.audio, talk);
  if (!audio) return audio.error();
  if (auto ok = dam::check_against_audio(spoken.script, audio->duration()); !ok) {
    return ok.error().in_file(options.script);
  }
  spoken.audio = std::move(*audio);
  return spoken;
}

Result<Spoken> align_voice(const SpokenOptions& options, const tools::Talk& talk) {
  Result<dam::Script> script =
      align_file(options.audio, options.transcript, options.language, talk);
  if (!script) return script.error();
  Result<media::Pcm> audio = read_voice(options.audio, talk);
  if (!audio) return audio.error();
  return Spoken{std::move(*script), std::move(*audio), {}};
}

}  // namespace

Result<dam::Script> align_file(const std::string& audio, const std::string& transcript,
                               const std::string& language, const tools::Talk& talk) {
  Result<media::Pcm> pcm = read_voice(audio, talk, voice::kAlignRate);
  if (!pcm) return pcm.error();
  voice::AlignOptions settings;
  settings.language = language;
  Result<voice::Alignment> alignment = voice::align(*pcm, transcript, settings);
  if (!alignment) return alignment.error().in_file(audio);
  for (const std::string& text : alignment->warnings) talk.warn(audio + ": " + text);
  return std::move(alignment->script);
}

bool has_source(const SpokenOptions& options) {
  return options.has_text || !options.text_file.empty() || !options.script.empty() ||
         options.has_transcript;
}

Result<Spoken> get_spoken(const SpokenOptions& options, const tools::Talk& talk) {
  if (!options.text_file.empty()) {
    Result<std::string> text = tools::read_text_file(options.text_file, tools::kMostWritten);
    if (!text) return text.error();
    Result<Spoken> spoken = speak(options, *text);
    if (!spoken) return spoken.error().in_file(options.text_file);
    return spoken;
  }
  if (options.has_text) return speak(options, options.text);
  if (!options.script.empty()) return follow_script(options, talk);
  return align_voice(options, talk);
}

Result<dam::Model> read_model(const std::string& path) {
  if (path.empty() || path == "builtin") return dam::builtin_model();
  Result<dam::Model> model = dam::load_model(path);
  if (!model) return model.error().in_file(path);
  return model;
}

}  // namespace animeme::speech
