#include "tools/voice/voice.h"

#include <algorithm>
#include <cmath>

#include "dam/script/script_text_internal.h"
#include "tools/voice/voice_events.h"
#include "tools/voice/voice_job.h"

namespace animeme::voice {
namespace {

constexpr std::size_t kMaxTextBytes = 400000;  // of UTF-8
constexpr std::size_t kMaxCharacters = 100000;

// UTF-8 that espeak-ng can be trusted with: valid, no control characters.
Result<std::string> clean_text(std::string_view text) {
  const auto too_long = [] {
    return make_error(Code::out_of_range,
                      "more than 100000 characters to speak; speak them in parts");
  };
  if (text.size() > kMaxTextBytes) return too_long();
  std::string out;
  std::size_t characters = 0;
  bool speakable = false;
  std::string utf8 = dam::to_utf8(text);
  for (std::string_view rest = utf8; !rest.empty(); ++characters) {
    const char32_t code = dam::take_code_point(rest);
    const bool blank = code <= U' ' || code == 0x7F || code == 0xA0 || code == 0xFFFD;
    dam::append_utf8(out, blank && code != U'\n' ? U' ' : code);
    speakable = speakable || !blank;
  }
  if (characters > kMaxCharacters) return too_long();
  if (!speakable) {
    return make_error(Code::invalid_argument, "there is no text to speak; give at least one word");
  }
  return out;
}

// Silence before and after; the events move along.
void pad(RawSpeech& raw, std::size_t before, std::size_t after) {
  raw.samples.insert(raw.samples.begin(), before, 0);
  raw.samples.insert(raw.samples.end(), after, 0);
  for (VoiceEvent& event : raw.events) event.sample += std::int64_t(before);
  VoiceEvent rest;
  rest.sample = std::int64_t(raw.samples.size() - after);
  rest.ipa = "_";
  raw.events.push_back(rest);
}

bool has_sound(const dam::Script& script) {
  return std::any_of(script.phones.begin(), script.phones.end(),
                     [](const dam::Phone& phone) { return phone.label != dam::kSilence; });
}

Error nothing_to_say(const std::string& voice) {
  return make_error(Code::invalid_argument,
                    "the voice " + voice +
                        " has nothing to say for this text; give words in its language or "
                        "choose another voice");
}

}  // namespace

Result<Speech> speak_text(std::string_view text, const VoiceOptions& options) {
  const auto voice = find_voice(options);
  if (!voice) return voice.error();
  const auto cleaned = clean_text(text);
  if (!cleaned) return cleaned.error();
  EspeakJob job;
  job.voice = voice->identifier;
  job.texts = {*cleaned};
  job.options = options;
  auto spoken = run_voice(job);
  if (!spoken) return spoken.error();
  const int rate = spoken->sample_rate;
  RawSpeech& raw = spoken->speech.front();
  pad(raw, std::size_t(std::lround(options.lead_silence * rate)),
      std::size_t(std::lround(options.tail_silence * rate)));
  Speech speech;
  speech.voice = voice->name;
  speech.script = make_voice_script(raw, rate, *cleaned);
  if (!has_sound(speech.script)) return nothing_to_say(voice->name);
  speech.audio.sample_rate = rate;
  speech.audio.samples.reserve(raw.samples.size());
  for (const std::int16_t sample : raw.samples) {
    speech.audio.samples.push_back(float(sample) / 32768.0f);
  }
  return speech;
}

Result<std::vector<std::vector<std::string>>> pronounce(const std::vector<std::string>& texts,
                                                        const VoiceOptions& options) {
  const auto voice = find_voice(options);
  if (!voice) return voice.error();
  EspeakJob job;
  job.voice = voice->identifier;
  job.options = options;
  for (const std::string& text : texts) {
    auto cleaned = clean_text(text);
    if (!cleaned) return cleaned.error();
    job.texts.push_back(*std::move(cleaned));
  }
  const auto spoken = run_voice(job);
  if (!spoken) return spoken.error();
  std::vector<std::vector<std::string>> all;
  for (const RawSpeech& raw : spoken->speech) {
    std::vector<std::string>& labels = all.emplace_back();
    for (const dam::Phone& phone : make_voice_script(raw, spoken->sample_rate, {}).phones) {
      if (phone.label != dam::kSilence) labels.push_back(phone.label);
    }
  }
  return all;
}

}  // namespace animeme::voice
