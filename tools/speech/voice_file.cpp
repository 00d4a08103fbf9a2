#include "tools/speech/voice_file.h"

#include <cmath>

#include "tools/files/files.h"
#include "tools/media/audio.h"
#include "tools/media/container.h"
#include "tools/scripts/script_text.h"
#include "tools/voice/word_phones.h"

namespace animeme::speech {

Result<dam::Script> read_script(const std::string& path, const ScriptInput& input,
                                const tools::Talk& talk, bool* from_words) {
  const Result<std::string> text = tools::read_text_file(path, tools::kMostWritten);
  if (!text) return text.error();
  return parse_script(*text, path, input, talk, from_words);
}

Result<dam::Script> parse_script(const std::string& text, const std::string& path,
                                 const ScriptInput& input, const tools::Talk& talk,
                                 bool* from_words) {
  Result<dam::Timings> timings = scripts::read_labels(text, input.reading);
  if (!timings) return timings.error().in_file(path);
  if (from_words != nullptr) *from_words = dam::has_words(*timings);
  if (dam::has_words(*timings)) {
    std::vector<std::string> warnings;
    voice::AlignOptions settings;
    settings.language = input.language;
    timings = voice::words_to_phones(*timings, settings, warnings);
    if (!timings) return timings.error().in_file(path);
    for (const std::string& warning : warnings) talk.warn(path + ": " + warning);
    talk.say(path + ": words with times; their phones are guessed by pronunciation");
  }
  Result<dam::Script> script = dam::make_script(*timings);
  if (!script) return script.error().in_file(path);
  if (script->duration() > input.most_seconds) {
    return make_error(Code::out_of_range,
                      "the script lasts " + std::to_string(std::llround(script->duration())) +
                          " s, at most " + std::to_string(std::llround(input.most_seconds)) +
                          " s are spoken; correct its times or allow more (--max-seconds)")
        .in_file(path);
  }
  return script;
}

Result<media::Pcm> read_voice(const std::string& path, const tools::Talk& talk, int sample_rate) {
  std::vector<std::string> warnings;
  media::ReadAudioOptions options;
  options.sample_rate = sample_rate;
  options.warnings = &warnings;
  Result<media::Pcm> audio = media::read_audio(path, options);
  if (!audio) return audio.error().in_file(path);
  for (const std::string& text : warnings) talk.warn(path + ": " + text);
  return audio;
}

double SoundInput::seconds() const {
  if (samples) return samples->duration();
  if (coded->length > 0) return double(coded->length) / coded->format.sample_rate;
  const media::AudioPacket& last = coded->packets.back();
  return double(last.time + last.duration) / coded->format.sample_rate;
}

void SoundInput::give_to(media::MuxInput& input) const {
  if (samples) input.audio = &*samples;
  if (coded) input.encoded = &*coded;
}

Result<SoundInput> read_sound(const std::string& path, const KeepCodec& keep,
                              const tools::Talk& talk) {
  SoundInput sound;
  Result<media::EncodedAudio> coded = media::read_encoded_audio(path);
  if (coded && keep(coded->format.codec)) {
    sound.coded = std::move(*coded);
    return sound;
  }
  if (!coded && coded.error().code != Code::unsupported) return coded.error().in_file(path);
  Result<media::Pcm> samples = read_voice(path, talk);
  if (!samples) return samples.error();
  sound.samples = std::move(*samples);
  return sound;
}

Result<media::EncodedAudio> read_coded_sound(const std::string& path, const KeepCodec& keep,
                                             const media::AudioSettings& settings,
                                             const tools::Talk& talk) {
  Result<SoundInput> sound = read_sound(path, keep, talk);
  if (!sound) return sound.error();
  if (sound->coded) return std::move(*sound->coded);
  return media::encode_audio(*sound->samples, settings);
}

}  // namespace animeme::speech
