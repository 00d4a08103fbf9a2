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
#include "tools/formats/media/audio.h"
#include "tools/formats/scripts/script_text.h"
#include "tools/speech/talking/written_text.h"
#include "tools/speech/text/mood_marks.h"
#include "tools/speech/voice/pitch.h"

namespace animeme::speech {

namespace {

// Sound in a file, and its prosody.
class SoundFile {
 public:
  static Result<std::unique_ptr<SoundFile>> make() {
    auto folder = tools::ScratchFolder::make();
    if (!folder) return folder.error();
    auto file = std::make_unique<SoundFile>();
    file->folder_ = std::move(*folder);
    return file;
  }
  Result<void> take(std::span<const float> samples, int sample_rate) {
    if (!wav_) {
      auto opened = media::WavWriter::open(path(), sample_rate);
      if (!opened) return opened.error();
      wav_ = std::move(*opened);
      meter_.emplace(sample_rate);
      rate_ = sample_rate;
    }
    meter_->push(samples);
    samples_ += samples.size();
    return wav_->write(samples);
  }
  double seconds() const { return double(samples_) / double(std::max(1, rate_)); }
  int sample_rate() const { return rate_; }
  std::uint64_t bytes() const { return 2 * samples_; }
  // Once.
  Result<void> give_to(Spoken& spoken) {
    if (auto done = wav_->finish(); !done) return done;
    spoken.audio.reset();
    spoken.recording = path();
    spoken.file_seconds = seconds();
    spoken.prosody = meter_->finish();
    spoken.folder = std::move(folder_);
    return {};
  }

 private:
  std::string path() const { return folder_->file("voice.wav"); }

  std::unique_ptr<tools::ScratchFolder> folder_;
  std::optional<media::WavWriter> wav_;
  std::optional<voice::ProsodyMeter> meter_;
  std::uint64_t samples_ = 0;
  int rate_ = 0;
};

// Short sound in memory, all of a longer one in a file.
class SoundKeeper {
 public:
  // As long as the keeper lives.
  voice::SoundSink sink() {
    return {[this](int sample_rate) { return begin(sample_rate); },
            [this](std::span<const float> samples) { return take(samples); }};
  }
  Result<void> give_to(Spoken& spoken) {
    if (file_) return file_->give_to(spoken);
    spoken.audio = std::move(short_);
    return {};
  }

 private:
  static constexpr std::size_t kMostInMemory = 60;  // seconds

  Result<void> begin(int sample_rate) {
    short_ = {sample_rate, {}};
    file_.reset();
    return {};
  }
  Result<void> take(std::span<const float> samples) {
    if (file_) return file_->take(samples, short_.sample_rate);
    short_.samples.insert(short_.samples.end(), samples.begin(), samples.end());
    if (short_.samples.size() <= kMostInMemory * std::size_t(short_.sample_rate)) return {};
    auto made = SoundFile::make();
    if (!made) return made.error();
    file_ = std::move(*made);
    const std::vector<float> kept = std::exchange(short_.samples, {});
    return file_->take(kept, short_.sample_rate);
  }

  media::Pcm short_;
  std::unique_ptr<SoundFile> file_;
};

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
  SoundKeeper keeper;
  Result<voice::Speech> speech =
      voice::speak_text(text, settings, options.sound_in_file ? keeper.sink() : voice::SoundSink{});
  if (!speech) return speech.error();
  for (const std::string& warning : speech->warnings) log.warn(warning);
  Spoken spoken{
      std::move(speech->script), std::move(speech->audio), speech->voice, TimesFrom::voice, {}, {}};
  if (options.sound_in_file) {
    if (auto given = keeper.give_to(spoken); !given) return given.error();
  }
  step.made(std::uint64_t(2 * std::llround(spoken.sound_seconds() * speech->audio.sample_rate)));
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

// Length and prosody of a recording, block by block.
Result<void> measure_recording(const std::string& path, Spoken& spoken, const tools::Log& log) {
  std::vector<std::string> warnings;
  media::ReadAudioOptions reading;
  reading.warnings = &warnings;
  auto reader = media::AudioReader::open(path, reading);
  if (!reader) return reader.error().in_file(path);
  voice::ProsodyMeter meter(reader->sample_rate());
  std::uint64_t samples = 0;
  for (;;) {
    const auto piece = reader->next();
    if (!piece) return piece.error().in_file(path);
    if (piece->empty()) break;
    samples += piece->size();
    meter.push(*piece);
  }
  for (const std::string& text : warnings) log.warn(path + ": " + text);
  spoken.file_seconds = double(samples) / reader->sample_rate();
  spoken.prosody = meter.finish();
  return {};
}

// The sound of options.audio, in memory or measured.
Result<void> add_recording(const SpokenOptions& options, Spoken& spoken, const tools::Log& log) {
  spoken.recording = again(options.audio);
  if (options.sound_in_file && !spoken.recording.empty()) {
    return measure_recording(options.audio, spoken, log);
  }
  Result<media::Pcm> audio = read_voice(options.audio, log);
  if (!audio) return audio.error();
  spoken.audio = std::move(*audio);
  return {};
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
  if (auto added = add_recording(options, spoken, log); !added) return added.error();
  if (auto ok = dam::check_against_audio(spoken.script, spoken.sound_seconds()); !ok) {
    return ok.error().in_file(options.script);
  }
  return spoken;
}

// Speaks cues without silence around them. A TTS command speaks each once, at its own speed.
class CueSpeaker {
 public:
  CueSpeaker(const SpokenOptions& options, const tools::Log& log) : options_(options), log_(log) {}

  Result<voice::Speech> operator()(std::size_t cue, const std::string& written, double speed) {
    const std::string text = text_to_say(written, options_.script_reading.speak_marks, log_);
    if (!options_.tts.empty()) return by_command(cue, text, speed);
    voice::VoiceOptions settings;
    settings.language = options_.language;
    settings.words_per_minute =
        std::clamp(int(std::lround(options_.words_per_minute * speed)), 80, 450);
    settings.pitch = options_.pitch;
    settings.lead_silence = settings.tail_silence = 0;
    return voice::speak_text(text, settings);
  }

 private:
  Result<voice::Speech> by_command(std::size_t cue, const std::string& text, double speed) {
    if (cue_ != cue) {
      VoiceCommand command = voice_command(options_);
      command.input.reading = {};  // that of the subtitles
      Result<TimedSpeech> timed = run_voice_command(text, command, log_);
      if (!timed) return timed.error();
      spoken_ = std::move(timed->speech);
      cue_ = cue;
    }
    double start = 0, end = spoken_.audio.duration();
    const std::vector<dam::Phone>& phones = spoken_.script.phones;
    if (phones.size() > 2 && phones.front().label == dam::kSilence) start = phones.front().end;
    if (phones.size() > 2 && phones.back().label == dam::kSilence) end = phones.back().start;
    voice::Speech part = stretched_part(spoken_.audio, spoken_.script, start, end, speed);
    part.voice = spoken_.voice;
    for (dam::MoodSpan span : spoken_.moods) {
      span.start = std::max(0.0, span.start - start) / speed;
      span.end = std::max(0.0, span.end - start) / speed;
      part.moods.push_back(std::move(span));
    }
    return part;
  }

  const SpokenOptions& options_;
  const tools::Log& log_;
  voice::Speech spoken_;            // by the command
  std::optional<std::size_t> cue_;  // which it is
};

Result<std::vector<Cue>> read_cues(const SpokenOptions& options, const tools::Log& log) {
  const Result<std::string> text = tools::read_text_file(options.script);
  if (!text) return text.error();
  const auto timings = scripts::read_labels(*text, options.script_reading);
  if (!timings) return timings.error().in_file(options.script);
  for (const dam::ScriptNote& note : timings->notes) {
    log.warn(options.script + ": " + note.describe());
  }
  auto cues = cues_of(*timings);
  if (!cues) return cues.error().in_file(options.script);
  return cues;
}

void tell_of_long_cues(const std::vector<FittedCue>& cues, const SpokenOptions& options,
                       const tools::Log& log) {
  for (std::size_t i = 0; i < cues.size(); ++i) {
    const FittedCue& cue = cues[i];
    if (cue.cut == 0) continue;
    char told[160];
    std::snprintf(told, sizeof told,
                  ": subtitle %zu (at %.2f s) ends %.2f s late; cut %zu of its characters", i + 1,
                  cue.cue.start, cue.late, cue.cut);
    log.warn(options.script + told);
  }
}

constexpr double kTail = 0.4;  // seconds to close the mouth

// `end`: of the sound, seconds.
void end_silently(voice::Speech& speech, double end) {
  speech.script.phones.push_back(
      {std::max(end, speech.script.duration()), end + kTail, std::string(dam::kSilence), {}});
}

std::vector<float> tail_of(int sample_rate) {
  return std::vector<float>(std::size_t(kTail * sample_rate), 0.0f);
}

void end_silently(voice::Speech& speech) {
  end_silently(speech, speech.audio.duration());
  const std::vector<float> tail = tail_of(speech.audio.sample_rate);
  speech.audio.samples.insert(speech.audio.samples.end(), tail.begin(), tail.end());
}

Result<Spoken> speak_cues(const SpokenOptions& options, const tools::Log& log) {
  tools::AtStep step(tools::Step::voice);
  const auto cues = read_cues(options, log);
  if (!cues) return cues.error();
  CueSpeaker speaker(options, log);
  const auto say = [&](std::size_t cue, double speed) {
    return speaker(cue, (*cues)[cue].text, speed);
  };
  std::unique_ptr<SoundFile> file;
  TakeSound take;
  if (options.sound_in_file) {
    auto made = SoundFile::make();
    if (!made) return made.error();
    file = std::move(*made);
    take = [&file](std::span<const float> samples, int rate) { return file->take(samples, rate); };
  }
  Result<FittedSpeech> fitted = fit_cues(*cues, say, *options.fit, take);
  if (!fitted) return fitted.error().in_file(options.script);
  tell_of_long_cues(fitted->cues, options, log);
  voice::Speech& speech = fitted->speech;
  file ? end_silently(speech, file->seconds()) : end_silently(speech);
  step.made(file ? file->bytes() : 2 * speech.audio.samples.size());
  Spoken spoken{std::move(speech.script), std::nullopt, speech.voice, TimesFrom::voice, {}, {}};
  if (!file) {
    spoken.audio = std::move(speech.audio);
  } else {
    const int rate = file->sample_rate();
    if (auto ended = file->take(tail_of(rate), rate); !ended) return ended.error();
    if (auto given = file->give_to(spoken); !given) return given.error();
  }
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
  dam::Script script = std::exchange(aligned->script, {});
  Spoken spoken{std::move(script), std::nullopt, {}, TimesFrom::alignment, std::move(*aligned), {}};
  spoken.moods = text::find_moods(text, spoken.script);
  // Its damage is reported already.
  if (auto added = add_recording(options, spoken, {}); !added) return added.error();
  return spoken;
}

// A recording of what subtitles say.
Result<Spoken> fit_recorded(const SpokenOptions& options, const tools::Log& log) {
  const auto cues = read_cues(options, log);
  if (!cues) return cues.error();
  SpokenOptions aligning = options;
  aligning.sound_in_file = false;  // it is cut and stretched
  aligning.transcript.clear();
  std::vector<std::string> texts;
  for (const Cue& cue : *cues) {
    texts.push_back(text_to_say(cue.text, options.script_reading.speak_marks, log));
    aligning.transcript += (aligning.transcript.empty() ? "" : "\n") + texts.back();
  }
  Result<Spoken> spoken = align_voice(aligning, log);
  if (!spoken) return spoken;
  const std::vector<RecordedCue> said = find_cues(texts, spoken->alignment->words);
  auto fitted = fit_recording(*cues, said, *spoken->audio, spoken->script, *options.fit);
  if (!fitted) return fitted.error().in_file(options.script);
  spoken->cues = std::move(fitted->cues);
  tell_of_long_cues(spoken->cues, options, log);
  if (!fitted->speech) return spoken;
  end_silently(*fitted->speech);
  spoken->script = std::move(fitted->speech->script);
  spoken->audio = std::move(fitted->speech->audio);
  spoken->moods = text::find_moods(aligning.transcript, spoken->script);
  spoken->recording.clear();
  // Words go with their cues; phones that were cut at its ends have no number of their own.
  for (voice::AlignedWord& word : spoken->alignment->words) {
    for (std::size_t i = 0; i < said.size(); ++i) {
      const double length = said[i].end - said[i].start;
      if (!(length > 0) || word.start < said[i].start || word.end > said[i].end) continue;
      const FittedCue& cue = spoken->cues[i];
      const double scale = cue.seconds / length;
      word.start = cue.start + (word.start - said[i].start) * scale;
      word.end = cue.start + (word.end - said[i].start) * scale;
      break;
    }
  }
  spoken->alignment->confidences.clear();
  return spoken;
}

Result<Spoken> hear_voice(const SpokenOptions& options, const tools::Log& log) {
  voice::ListenOptions settings;
  settings.language = options.language;
  settings.progress = options.heard;
  Result<voice::Recognition> heard = listen_to_file(options.audio, settings, log);
  if (!heard) return heard.error();
  dam::Script script = heard->script;
  Spoken spoken{std::move(script), std::nullopt, {}, TimesFrom::sound, {}, std::move(*heard)};
  // Its damage is reported already.
  if (auto added = add_recording(options, spoken, {}); !added) return added.error();
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
  Result<voice::Alignment> alignment = voice::align(std::move(*pcm), transcript, options);
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
  if (!options.script.empty() && options.fit) {
    return options.audio.empty() ? speak_cues(options, log) : fit_recorded(options, log);
  }
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
