#include "tools/speech/voice/voice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "dam/script/script_text_internal.h"
#include "tools/speech/text/utterance.h"
#include "tools/speech/voice/voice_events.h"
#include "tools/speech/voice/voice_job.h"
#include "tools/speech/voice/voice_languages.h"

namespace animeme::voice {
namespace {

constexpr std::size_t kMaxTextBytes = 400000;  // of UTF-8
constexpr std::size_t kMaxCharacters = 100000;
constexpr double kMostSilence = 600;  // seconds around the words

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

// Silence before and after; the events move along, and the samples stay as they are.
void pad(RawSpeech& raw, std::size_t before, std::size_t after) {
  raw.silent.insert(raw.silent.begin(), before, true);
  raw.silent.insert(raw.silent.end(), after, true);
  for (VoiceEvent& event : raw.events) event.sample += std::int64_t(before);
  VoiceEvent rest;
  rest.sample = std::int64_t(raw.silent.size() - after);
  rest.ipa = "_";
  raw.events.push_back(rest);
}

std::vector<float> silence(double seconds, int sample_rate) {
  return std::vector<float>(std::size_t(std::lround(seconds * sample_rate)), 0.0f);
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

EspeakJob job_of(const text::Utterance& utterance, const VoiceOptions& options) {
  EspeakJob job;
  job.voice = utterance.speakers.front().voice;
  job.texts = {text::utf8(utterance.input.text)};
  job.options = options;
  job.markup = utterance.markup;
  job.mnemonics = utterance.mnemonics;
  return job;
}

// Asks the voice for the vowel signs of a text, one syllable each. Nothing where it cannot tell.
std::string ask_for_vowel_signs(std::string_view text, const std::string& voice,
                                const VoiceOptions& options) {
  const std::vector<VowelSign> signs = vowel_signs(text::code_points(text));
  if (signs.empty()) return {};
  std::vector<std::string> syllables;
  for (const VowelSign& one : signs) syllables.push_back(one.syllable);
  const auto phones = pronounce(syllables, options);
  return phones ? warn_of_vowel_signs(signs, *phones, voice) : std::string();
}

}  // namespace

Result<Speech> speak_text(std::string_view text, const VoiceOptions& options,
                          const SoundSink& sink) {
  const auto cleaned = clean_text(text);
  auto speakers = find_speakers(options, cleaned ? text::code_points(*cleaned) : std::u32string());
  if (!speakers) return speakers.error();
  if (!cleaned) return cleaned.error();
  auto utterance = text::make_utterance(*cleaned, *std::move(speakers), helpers_of(options));
  if (!utterance) return utterance.error();
  Speech speech;
  speech.voice = utterance->speakers.front().name;
  speech.warnings = std::move(utterance->warnings);
  const double lead = options.lead_silence + utterance->lead_break;
  const double tail = options.tail_silence + utterance->tail_break;
  if (lead + tail > kMostSilence) {
    return make_error(Code::out_of_range,
                      "more than ten minutes of breaks around the words; shorten them");
  }
  EspeakJob job = job_of(*utterance, options);
  const bool sinks = sink.begin && sink.take;
  if (sinks) {
    job.sink.take = sink.take;
    job.sink.begin = [&](int sample_rate) -> Result<void> {
      if (auto begun = sink.begin(sample_rate); !begun) return begun;
      return sink.take(silence(lead, sample_rate));
    };
  }
  auto spoken = run_voice(job);
  if (!spoken) return spoken.error();
  const int rate = spoken->sample_rate;
  RawSpeech& raw = spoken->speech.front();
  if (job.markup) correct_ipa(raw, *utterance);
  const std::vector<float> before = silence(lead, rate);
  const std::vector<float> after = silence(tail, rate);
  if (sinks) {
    if (auto taken = sink.take(after); !taken) return taken.error();
  }
  pad(raw, before.size(), after.size());
  speech.script = make_voice_script(raw, rate, *utterance);
  if (!has_sound(speech.script)) return nothing_to_say(speech.voice);
  speech.languages = find_languages(raw, rate, *utterance);
  speech.marks = find_marks(raw, rate, *utterance);
  speech.moods = find_moods(raw, rate, *utterance, speech.script);
  std::string letters = warn_of_letters(raw, *utterance, speech.languages);
  if (!letters.empty()) speech.warnings.push_back(std::move(letters));
  std::string vowels;
  if (utterance->speakers.size() == 1) {
    vowels = ask_for_vowel_signs(*cleaned, speech.voice, options);
  }
  if (vowels.empty()) vowels = warn_of_missing_vowels(speech.script, speech.voice);
  if (!vowels.empty()) speech.warnings.push_back(std::move(vowels));
  speech.audio.sample_rate = rate;
  if (sinks) return speech;
  std::vector<float>& samples = speech.audio.samples;
  samples.reserve(raw.silent.size());
  samples = before;
  for (const std::int16_t sample : raw.samples) samples.push_back(float(sample) / 32768.0f);
  samples.insert(samples.end(), after.begin(), after.end());
  return speech;
}

Result<std::vector<std::vector<std::string>>> pronounce(const std::vector<std::string>& texts,
                                                        const VoiceOptions& options,
                                                        bool mark_words) {
  // Texts that one voice speaks as they are go together; the others have markup, or another voice.
  std::map<std::pair<std::string, bool>, std::vector<std::size_t>> together;
  std::vector<text::Utterance> utterances;
  std::optional<text::Speakers> known;
  for (const std::string& text : texts) {
    auto cleaned = clean_text(text);
    if (!known || known->automatic) {
      auto speakers =
          find_speakers(options, cleaned ? text::code_points(*cleaned) : std::u32string());
      if (!speakers) return speakers.error();
      known = *std::move(speakers);
    }
    if (!cleaned) return cleaned.error();
    auto utterance = text::make_utterance(*cleaned, *known, helpers_of(options));
    if (!utterance) return utterance.error();
    together[{utterance->speakers.front().voice, utterance->markup}].push_back(utterances.size());
    utterances.push_back(*std::move(utterance));
  }
  std::vector<std::vector<std::string>> all(texts.size());
  for (const auto& [key, numbers] : together) {
    EspeakJob job = job_of(utterances[numbers.front()], options);
    job.texts.clear();
    for (const std::size_t i : numbers) job.texts.push_back(text::utf8(utterances[i].input.text));
    auto spoken = run_voice(job);
    if (!spoken) return spoken.error();
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      RawSpeech& raw = spoken->speech[k];
      const text::Utterance& utterance = utterances[numbers[k]];
      if (utterance.markup) correct_ipa(raw, utterance);
      std::vector<std::string>& labels = all[numbers[k]];
      std::string word;
      for (const dam::Phone& phone :
           make_voice_script(raw, spoken->sample_rate, utterance).phones) {
        if (phone.label == dam::kSilence) continue;
        const bool another = mark_words && !labels.empty() && phone.word != word;
        if (another) labels.emplace_back(dam::kSilence);
        word = phone.word;
        labels.push_back(phone.label);
      }
    }
  }
  if (texts.empty()) {
    if (const auto voice = find_voice(options); !voice) return voice.error();
  }
  return all;
}

}  // namespace animeme::voice
