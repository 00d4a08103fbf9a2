#include "tools/speech/talking/spoken.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "dam/model/builtin.h"
#include "dam/speaking/readings.h"
#include "tools/formats/files/cost.h"
#include "tools/formats/files/file_cache.h"
#include "tools/formats/files/files.h"
#include "tools/formats/scripts/script_text.h"
#include "tools/speech/talking/written_text.h"
#include "tools/speech/text/mood_marks.h"

namespace animeme::speech {

namespace {

Result<Spoken> speak(const SpokenOptions& options, const std::string& written,
                     const tools::Log& log) {
  tools::AtStep step(tools::Step::voice);
  const std::string text = text_to_say(written, options.script_reading.speak_marks, log);
  if (!options.tts.empty()) {
    Result<TimedSpeech> timed = run_voice_command(text, voice_command(options), log);
    if (!timed) return timed.error();
    voice::Speech& speech = timed->speech;
    Spoken spoken{std::move(speech.script),    std::move(speech.audio),
                  std::move(speech.voice),     timed->times,
                  std::move(timed->alignment), {}};
    spoken.moods = std::move(speech.moods);
    return spoken;
  }
  voice::VoiceOptions settings;
  settings.language = options.language;
  settings.words_per_minute = options.words_per_minute;
  settings.pitch = options.pitch;
  Result<voice::Speech> speech = voice::speak_text(text, settings);
  if (!speech) return speech.error();
  for (const std::string& warning : speech->warnings) log.warn(warning);
  step.made(2 * speech->audio.samples.size());
  Spoken spoken{
      std::move(speech->script), std::move(speech->audio), speech->voice, TimesFrom::voice, {}, {}};
  spoken.languages = std::move(speech->languages);
  spoken.marks = std::move(speech->marks);
  spoken.moods = std::move(speech->moods);
  spoken.warnings = std::move(speech->warnings);
  return spoken;
}

// The path, if the file can be read once more.
std::string again(const std::string& path) {
  std::error_code status;
  return std::filesystem::is_regular_file(path, status) ? path : std::string();
}

Result<Spoken> follow_script(const SpokenOptions& options, const tools::Log& log) {
  bool words = false;
  Result<dam::Script> script =
      read_script(options.script, {options.script_reading, options.language, options.most_seconds},
                  log, &words);
  if (!script) return script.error();
  Spoken spoken{
      std::move(*script), std::nullopt, {}, words ? TimesFrom::words : TimesFrom::script, {}, {}};
  if (options.audio.empty()) return spoken;
  Result<media::Pcm> audio = read_voice(options.audio, log);
  if (!audio) return audio.error();
  if (auto ok = dam::check_against_audio(spoken.script, audio->duration()); !ok) {
    return ok.error().in_file(options.script);
  }
  spoken.audio = std::move(*audio);
  spoken.recording = again(options.audio);
  return spoken;
}

// One cue of subtitles, without silence around it.
Result<voice::Speech> speak_cue(const SpokenOptions& options, const std::string& written,
                                double speed, const tools::Log& log) {
  const std::string text = text_to_say(written, options.script_reading.speak_marks, log);
  if (!options.tts.empty()) {
    Result<TimedSpeech> timed = run_voice_command(text, voice_command(options), log);
    if (!timed) return timed.error();
    return std::move(timed->speech);
  }
  voice::VoiceOptions settings;
  settings.language = options.language;
  settings.words_per_minute =
      std::clamp(int(std::lround(options.words_per_minute * speed)), 80, 450);
  settings.pitch = options.pitch;
  settings.lead_silence = settings.tail_silence = 0;
  return voice::speak_text(text, settings);
}

Result<Spoken> speak_cues(const SpokenOptions& options, const tools::Log& log) {
  tools::AtStep step(tools::Step::voice);
  const Result<std::string> text = tools::read_text_file(options.script);
  if (!text) return text.error();
  const auto timings = scripts::read_labels(*text, options.script_reading);
  if (!timings) return timings.error().in_file(options.script);
  const auto cues = cues_of(*timings);
  if (!cues) return cues.error().in_file(options.script);
  const auto say = [&](const std::string& words, double speed) {
    return speak_cue(options, words, speed, log);
  };
  Result<FittedSpeech> fitted = fit_cues(*cues, say, *options.fit);
  if (!fitted) return fitted.error().in_file(options.script);
  for (std::size_t i = 0; i < fitted->cues.size(); ++i) {
    const FittedCue& cue = fitted->cues[i];
    if (cue.cut == 0) continue;
    char told[160];
    std::snprintf(told, sizeof told,
                  ": subtitle %zu (at %.2f s) ends %.2f s late; cut %zu of its characters", i + 1,
                  cue.cue.start, cue.late, cue.cut);
    log.warn(options.script + told);
  }
  voice::Speech& speech = fitted->speech;
  // Time to close the mouth.
  constexpr double kTail = 0.4;
  const double end = speech.audio.duration();
  speech.audio.samples.resize(speech.audio.samples.size() +
                              std::size_t(kTail * speech.audio.sample_rate));
  speech.script.phones.push_back(
      {std::max(end, speech.script.duration()), end + kTail, std::string(dam::kSilence), {}});
  step.made(2 * speech.audio.samples.size());
  Spoken spoken{
      std::move(speech.script), std::move(speech.audio), speech.voice, TimesFrom::voice, {}, {}};
  spoken.languages = std::move(speech.languages);
  spoken.moods = std::move(speech.moods);
  spoken.warnings = std::move(speech.warnings);
  spoken.cues = std::move(fitted->cues);
  for (const std::string& warning : spoken.warnings) log.warn(warning);
  return spoken;
}

Result<Spoken> align_voice(const SpokenOptions& options, const tools::Log& log) {
  voice::AlignOptions settings;
  settings.language = options.language;
  settings.least_confidence = options.least_confidence;
  const std::string text = text_to_say(options.transcript, options.script_reading.speak_marks, log);
  Result<voice::Alignment> aligned = align_file(options.audio, text, settings, log);
  if (!aligned) return aligned.error();
  Result<media::Pcm> audio = read_voice(options.audio);  // its damage is reported already
  if (!audio) return audio.error();
  dam::Script script = std::exchange(aligned->script, {});
  Spoken spoken{std::move(script),    std::move(*audio),   {},
                TimesFrom::alignment, std::move(*aligned), {}};
  spoken.moods = text::find_moods(text, spoken.script);
  spoken.recording = again(options.audio);
  return spoken;
}

Result<Spoken> hear_voice(const SpokenOptions& options, const tools::Log& log) {
  voice::ListenOptions settings;
  settings.language = options.language;
  settings.progress = options.heard;
  Result<voice::Recognition> heard = listen_to_file(options.audio, settings, log);
  if (!heard) return heard.error();
  Result<media::Pcm> audio = read_voice(options.audio);  // its damage is reported already
  if (!audio) return audio.error();
  dam::Script script = heard->script;
  Spoken spoken{std::move(script), std::move(*audio), {}, TimesFrom::sound, {}, std::move(*heard)};
  spoken.recording = again(options.audio);
  return spoken;
}

}  // namespace

VoiceCommand voice_command(const SpokenOptions& options) {
  return {options.tts, {options.script_reading, options.language, options.most_seconds}};
}

Result<voice::Alignment> align_file(const std::string& audio, const std::string& transcript,
                                    const voice::AlignOptions& options, const tools::Log& log) {
  const tools::AtStep step(tools::Step::alignment);
  Result<media::Pcm> pcm = read_voice(audio, log, voice::kAlignRate);
  if (!pcm) return pcm.error();
  Result<voice::Alignment> alignment = voice::align(*pcm, transcript, options);
  if (!alignment) return alignment.error().in_file(audio);
  for (const std::string& text : alignment->warnings) log.warn(audio + ": " + text);
  return alignment;
}

Result<voice::Recognition> listen_to_file(const std::string& audio,
                                          const voice::ListenOptions& options,
                                          const tools::Log& log) {
  const tools::AtStep step(tools::Step::alignment);
  Result<media::Pcm> pcm = read_voice(audio, log, voice::kAlignRate);
  if (!pcm) return pcm.error();
  Result<voice::Recognition> heard = voice::listen(*pcm, options);
  if (!heard) return heard.error().in_file(audio);
  for (const std::string& text : heard->warnings) log.warn(audio + ": " + text);
  return heard;
}

Result<dam::Signal> move_face(const dam::Model& model, const Spoken& spoken,
                              const dam::SynthesisOptions& options, dam::SynthesisReport* report) {
  const tools::AtStep step(tools::Step::speaking);
  if (!spoken.heard) return dam::synthesise(model, spoken.script, options, report);
  return dam::synthesise_readings(model, spoken.heard->readings, spoken.script, options, report);
}

Result<std::string> words_of_file(const std::string& path, const dam::ScriptOptions& reading) {
  Result<std::string> text = tools::read_text_file(path, tools::kMostWritten);
  if (!text) return text.error();
  Result<dam::Timings> timings = scripts::read_labels(*text, reading);
  if (!timings) return timings.error().in_file(path);
  std::string words;
  const dam::TimedLabel* before = nullptr;
  for (const dam::TimedLabel& label : timings->labels) {
    // The phones of a word usually follow each other without a gap.
    const bool same = before != nullptr && !label.is_word && label.word == before->word &&
                      label.link != dam::WordLink::again &&
                      (label.link == dam::WordLink::continued ||
                       label.start <= before->end + dam::kTimeTolerance);
    before = &label;
    if (!same) words += (label.is_word ? label.label : label.word) + " ";
  }
  if (words.find_first_not_of(' ') == std::string::npos) {
    return make_error(Code::not_found, "the script has no words to align, only phones")
        .in_file(path);
  }
  return words;
}

bool has_source(const SpokenOptions& options) {
  return options.has_text || !options.text_file.empty() || !options.script.empty() ||
         options.has_transcript || (options.listen && !options.audio.empty());
}

Result<Spoken> get_spoken(const SpokenOptions& options, const tools::Log& log) {
  if (!options.text_file.empty()) {
    Result<std::string> text = tools::read_text_file(options.text_file, tools::kMostWritten);
    if (!text) return text.error();
    Result<Spoken> spoken = speak(options, *text, log);
    if (!spoken) return spoken.error().in_file(options.text_file);
    return spoken;
  }
  if (options.has_text) return speak(options, options.text, log);
  if (!options.script.empty() && options.fit) return speak_cues(options, log);
  if (!options.script.empty()) return follow_script(options, log);
  if (options.listen && !options.has_transcript) return hear_voice(options, log);
  return align_voice(options, log);
}

Result<dam::Model> read_model(const std::string& path) {
  // Batches ask again and again.
  static tools::FileCache<dam::Model> cache;
  return cache.get(path == "builtin" ? "" : path, {}, [&]() -> Result<dam::Model> {
    if (path.empty() || path == "builtin") return dam::builtin_model();
    Result<dam::Model> model = dam::load_model(path);
    if (!model) return model.error().in_file(path);
    return model;
  });
}

}  // namespace animeme::speech
