#include "tools/voice/voice_job.h"

#include <filesystem>
#include <map>
#include <mutex>

#include "tools/voice/espeak_ipa.h"
#include "tools/voice/voice_choice.h"

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

}  // namespace

Result<FoundVoice> find_voice(const VoiceOptions& options) {
  if (auto good = check(options); !good) return good.error();
  if (auto good = check_data(options.data_path); !good) return good.error();
  const auto lists = cached_lists(options.data_path);
  if (!lists) return lists.error();
  const auto voice = choose_voice(options.language, *lists);
  if (!voice) return voice.error();
  const std::string file = voice->identifier.substr(0, voice->identifier.find('+'));
  return FoundVoice{voice->identifier, voice->name, file, lists->data_path};
}

Result<EspeakResult> run_voice(const EspeakJob& job) {
  auto result = run_espeak(job);
  if (!result) return result;
  for (RawSpeech& raw : result->speech) {
    for (VoiceEvent& event : raw.events) event.ipa = meant_ipa(job.voice, event.ipa);
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
