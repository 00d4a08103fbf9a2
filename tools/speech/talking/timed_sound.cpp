#include "tools/speech/talking/timed_sound.h"

#include <utility>

#include "tools/formats/media/audio.h"
#include "tools/speech/text/mood_marks.h"
#include "tools/speech/text/ssml.h"

namespace animeme::speech {

namespace {

// Silence from the last phone to the end of the sound.
void cover(dam::Script& script, double seconds) {
  if (script.duration() >= seconds) return;
  if (!script.phones.empty() && script.phones.back().label == dam::kSilence) {
    script.phones.back().end = seconds;
  } else {
    script.phones.push_back({script.duration(), seconds, std::string(dam::kSilence), {}});
  }
}

Result<TimedSpeech> by_labels(TimedSound& sound, const ScriptInput& input, const tools::Log& log) {
  bool words = false;
  Result<dam::Script> script = parse_script(sound.labels, sound.from, input, log, &words);
  if (!script) return script.error();
  if (!sound.audio.samples.empty()) {
    if (auto ok = dam::check_against_audio(*script, sound.audio.duration()); !ok) {
      return ok.error().in_file(sound.from);
    }
  }
  TimedSpeech timed;
  timed.speech.script = std::move(*script);
  timed.times = words ? TimesFrom::words : TimesFrom::script;
  return timed;
}

Result<TimedSpeech> by_alignment(const TimedSound& sound, const ScriptInput& input,
                                 const tools::Log& log) {
  Result<media::Pcm> pcm = media::resample(sound.audio, voice::kAlignRate);
  if (!pcm) return pcm.error();
  voice::AlignOptions settings;
  settings.language = input.language;
  Result<voice::Alignment> alignment = voice::align(std::move(*pcm), sound.text, settings);
  if (!alignment) return alignment.error();
  for (const std::string& warning : alignment->warnings) log.warn(warning);
  TimedSpeech timed;
  timed.speech.script = std::exchange(alignment->script, {});
  timed.times = TimesFrom::alignment;
  timed.alignment = std::move(*alignment);
  return timed;
}

}  // namespace

const char* name_of(TimesFrom times) {
  switch (times) {
    case TimesFrom::voice:
      return "voice";
    case TimesFrom::script:
      return "script";
    case TimesFrom::words:
      return "words";
    case TimesFrom::alignment:
      return "alignment";
    case TimesFrom::sound:
      break;
  }
  return "sound";
}

Result<TimedSpeech> time_sound(TimedSound sound, const ScriptInput& input, const tools::Log& log) {
  std::optional<TimedSpeech> timed;
  if (!sound.labels.empty()) {
    Result<TimedSpeech> labelled = by_labels(sound, input, log);
    if (labelled) {
      timed = std::move(*labelled);
    } else if (!sound.labels_may_be_none || sound.text.empty()) {
      return labelled.error();
    } else {
      log.info(sound.from + ": no script (" + labelled.error().message +
               "); the sounds are found by alignment");
    }
  }
  if (!timed) {
    if (sound.text.empty() || sound.audio.samples.empty()) {
      return make_error(Code::invalid_argument,
                        "neither timings nor a text to align; give one of them");
    }
    Result<TimedSpeech> aligned = by_alignment(sound, input, log);
    if (!aligned) return aligned.error();
    timed = std::move(*aligned);
  }
  cover(timed->speech.script, sound.audio.samples.empty() ? 0 : sound.audio.duration());
  timed->speech.audio = std::move(sound.audio);
  if (!text::is_ssml(sound.text)) {
    timed->speech.moods = text::find_moods(sound.text, timed->speech.script);
  }
  return std::move(*timed);
}

}  // namespace animeme::speech
