#include "tools/speech/voice/voice_job.h"

#include <filesystem>
#include <map>
#include <mutex>

#include "tools/speech/text/unicode.h"
#include "tools/speech/voice/espeak_ipa.h"
#include "tools/speech/voice/symbols.h"
#include "tools/speech/voice/voice_choice.h"

namespace animeme::voice {
namespace {

constexpr double kMaxSilence = 10.0;

Result<void> check(const VoiceOptions& options) {
  const auto range = [](std::string_view name, int low, int high) {
    return make_error(
        Code::invalid_argument,
        std::string(name) + " must be from " + std::to_string(low) + " to " + std::to_string(high));
  };
  const auto outside = [](int value, int low, int high) { return value < low || value > high; };
  if (outside(options.words_per_minute, 80, 450)) return range("words per minute", 80, 450);
  if (outside(options.pitch, 0, 100)) return range("the pitch", 0, 100);
  if (outside(options.pitch_range, 0, 100)) return range("the pitch range", 0, 100);
  if (outside(options.word_gap, 0, 100)) return range("the word gap", 0, 100);
  for (const double silence : {options.lead_silence, options.tail_silence}) {
    if (!(silence >= 0 && silence <= kMaxSilence)) {
      return range("the silence before and after the speech (seconds)", 0, 10);
    }
  }
  return {};
}

// Voice files do not change while a program runs, and reading them all takes a while.
Result<VoiceLists> cached_lists(const std::string& data_path) {
  static std::mutex mutex;
  static std::map<std::string, VoiceLists> cache;
  const std::lock_guard lock(mutex);
  const auto known = cache.find(data_path);
  if (known != cache.end()) return known->second;
  auto lists = read_espeak_voices(data_path);
  if (lists) cache.emplace(data_path, *lists);
  return lists;
}

// espeak-ng would silently use another folder.
Result<void> check_data(const std::string& data_path) {
  const std::filesystem::path path(data_path);
  std::error_code ignored;
  if (data_path.empty() || std::filesystem::exists(path / "espeak-ng-data" / "phontab", ignored) ||
      std::filesystem::exists(path / "phontab", ignored)) {
    return {};
  }
  return make_error(Code::not_found, "no espeak-ng-data in " + data_path +
                                         "; set the data path to the folder that contains it or "
                                         "leave it empty");
}

// Mandarin by pinyin, whatever voice of it is asked for: that of characters reads them in English.
text::Speaker speaker_of(const ChosenVoice& voice) {
  text::Speaker speaker = text::make_speaker(voice.language, voice.identifier, voice.name);
  const std::string mandarin = "sit/cmn";
  const std::string_view rest =
      std::string_view(voice.identifier).substr(std::min(mandarin.size(), voice.identifier.size()));
  const bool plain = voice.identifier.starts_with(mandarin) && (rest.empty() || rest[0] == '+');
  if (plain && text::unicode_here()) {
    speaker.voice = mandarin + "-Latn-pinyin" + std::string(rest);
    speaker.name = "Chinese (Mandarin)";
  }
  return speaker;
}

}  // namespace

Result<FoundVoice> find_voice(const VoiceOptions& options) {
  if (auto good = check(options); !good) return good.error();
  if (auto good = check_data(options.data_path); !good) return good.error();
  const auto lists = cached_lists(options.data_path);
  if (!lists) return lists.error();
  const auto chosen = choose_voices(options.language, *lists);
  if (!chosen) return chosen.error();
  const auto voice = chosen->voices.empty() ? choose_voice(text::locale_language(), {}, *lists)
                                            : chosen->voices.front();
  if (!voice) return voice.error();
  const std::string file = voice->identifier.substr(0, voice->identifier.find('+'));
  return FoundVoice{voice->identifier, voice->name, voice->language, file, lists->data_path};
}

Result<text::Speakers> find_speakers(const VoiceOptions& options, std::u32string_view text) {
  if (auto main = find_voice(options); !main) return main.error();
  const auto lists = cached_lists(options.data_path);
  if (!lists) return lists.error();
  const auto chosen = choose_voices(options.language, *lists);
  if (!chosen) return chosen.error();
  text::Speakers speakers;
  speakers.automatic = chosen->automatic;
  speakers.find = [lists = *lists, variant = chosen->variant](
                      const std::string& language) -> std::optional<text::Speaker> {
    auto voice = choose_voice(language, variant, lists);
    if (!voice) return std::nullopt;
    return speaker_of(*voice);
  };
  for (const ChosenVoice& voice : chosen->voices) speakers.list.push_back(speaker_of(voice));
  if (!speakers.list.empty()) return speakers;
  // No voice is named: the first letters decide which one is the main voice.
  for (const std::string& language : {text::first_language(text), text::locale_language()}) {
    auto found = language.empty() ? std::nullopt : speakers.find(language);
    if (found && speakers.list.empty()) speakers.list.push_back(*std::move(found));
  }
  if (!speakers.list.empty()) return speakers;
  const auto english = choose_voice("en", {}, *lists);
  if (!english) return english.error();
  speakers.list.push_back(speaker_of(*english));
  return speakers;
}

text::Helpers helpers_of(const VoiceOptions& options) {
  text::Helpers helpers;
  helpers.find = [options](const std::string& language,
                           const std::string& name) -> std::optional<text::Speaker> {
    const auto lists = cached_lists(options.data_path);
    if (!lists) return std::nullopt;
    // A variant of the language, else a voice by its name.
    for (const std::string& wanted : {language + (name.empty() ? "" : "+" + name), name}) {
      const auto chosen = choose_voices(wanted, *lists);
      if (wanted.empty() || !chosen || chosen->voices.empty()) continue;
      return speaker_of(chosen->voices.back());
    }
    return std::nullopt;
  };
  helpers.mnemonics = [options](const text::Speaker& speaker, const std::string& ipa,
                                std::vector<std::string>& replaced) {
    return mnemonics_of(speaker.voice, ipa, options, &replaced);
  };
  return helpers;
}

Result<EspeakResult> run_voice(const EspeakJob& job) {
  auto result = run_espeak(job);
  if (!result) return result;
  for (RawSpeech& raw : result->speech) {
    if (job.markup) break;
    for (std::size_t i = 0; i < raw.events.size(); ++i) {
      VoiceEvent& event = raw.events[i];
      event.ipa = meant_ipa(job.voice, event.ipa, ipa_behind(raw.events, i));
    }
  }
  return result;
}

Result<std::vector<VoiceInfo>> list_voices(const std::string& data_path) {
  if (auto good = check_data(data_path); !good) return good.error();
  const auto lists = cached_lists(data_path);
  if (!lists) return lists.error();
  return lists->voices;
}

}  // namespace animeme::voice
