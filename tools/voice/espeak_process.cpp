#include "tools/voice/espeak_process.h"

#include <espeak-ng/speak_lib.h>

#include <algorithm>
#include <cstring>

#include "tools/voice/child.h"

namespace animeme::voice {
namespace {

// Messages from the child.
enum Tag : std::uint32_t {
  kSampleRate,
  kSamples,  // int16 in the byte order of the machine
  kEvents,   // WireEvent
  kTextEnd,  // one text is spoken
  kVoice,    // name, identifier, language, language ... each ended by a zero byte
  kVariant,  // identifier
  kDataPath,
  kFailure,  // a sentence for people
};

struct WireEvent {
  std::int32_t kind, sample, text_position, text_length;
  char name[8];
};

// The callback of espeak-ng has no user pointer that survives all events; there is one sender in
// a child process.
Sender* g_sender = nullptr;

template <class T>
std::string_view bytes_of(const T* data, std::size_t count) {
  return {reinterpret_cast<const char*>(data), count * sizeof(T)};
}

int on_speech(short* samples, int count, espeak_EVENT* events) {
  bool good = true;
  if (samples != nullptr && count > 0) {
    good = g_sender->send(kSamples, bytes_of(samples, std::size_t(count)));
  }
  for (; good && events != nullptr && events->type != espeakEVENT_LIST_TERMINATED; ++events) {
    const bool word = events->type == espeakEVENT_WORD, mark = events->type == espeakEVENT_MARK;
    if (!word && !mark && events->type != espeakEVENT_PHONEME) continue;
    WireEvent wire{word   ? 0
                   : mark ? 2
                          : 1,
                   events->sample,
                   events->text_position,
                   events->length,
                   {}};
    if (mark && events->id.name != nullptr) {
      std::strncpy(wire.name, events->id.name, sizeof wire.name - 1);
    } else if (!word) {
      std::memcpy(wire.name, events->id.string, sizeof wire.name);
    }
    good = g_sender->send(kEvents, bytes_of(&wire, 1));
  }
  return good ? 0 : 1;
}

bool start(Sender& sender, const std::string& data_path) {
  const std::int32_t rate = espeak_Initialize(
      AUDIO_OUTPUT_SYNCHRONOUS, 0, data_path.empty() ? nullptr : data_path.c_str(),
      espeakINITIALIZE_PHONEME_EVENTS | espeakINITIALIZE_PHONEME_IPA | espeakINITIALIZE_DONT_EXIT);
  return rate > 0 && sender.send(kSampleRate, bytes_of(&rate, 1));
}

constexpr std::string_view kNoData =
    "espeak-ng cannot load its data; install the Debian package espeak-ng-data or set the data "
    "path to the folder that contains espeak-ng-data";

bool speak_all(Sender& sender, const EspeakJob& job) {
  if (!start(sender, job.options.data_path)) return sender.send(kFailure, kNoData);
  g_sender = &sender;
  espeak_SetSynthCallback(on_speech);
  if (espeak_SetVoiceByName(job.voice.c_str()) != EE_OK) {
    return sender.send(kFailure, "espeak-ng cannot load its voice " + job.voice);
  }
  espeak_SetParameter(espeakRATE, job.options.words_per_minute, 0);
  espeak_SetParameter(espeakPITCH, job.options.pitch, 0);
  espeak_SetParameter(espeakRANGE, job.options.pitch_range, 0);
  espeak_SetParameter(espeakWORDGAP, job.options.word_gap, 0);
  const unsigned flags =
      espeakCHARS_UTF8 | (job.mnemonics ? espeakPHONEMES : 0) | (job.markup ? espeakSSML : 0);
  for (const std::string& text : job.texts) {
    if (espeak_Synth(text.c_str(), text.size() + 1, 0, POS_CHARACTER, 0, flags, nullptr, nullptr) !=
        EE_OK) {
      return sender.send(kFailure, "espeak-ng failed to speak the text");
    }
    if (!sender.send(kTextEnd, {})) return false;
  }
  return true;
}

bool send_voices(Sender& sender, const std::string& data_path) {
  if (!start(sender, data_path)) return sender.send(kFailure, kNoData);
  const char* data = nullptr;
  espeak_Info(&data);
  if (data != nullptr && !sender.send(kDataPath, data)) return false;
  const espeak_VOICE** list = espeak_ListVoices(nullptr);
  for (; list != nullptr && *list != nullptr; ++list) {
    const espeak_VOICE& voice = **list;
    std::string wire = std::string(voice.name) + '\0' + voice.identifier + '\0';
    // Each language is a priority byte and a string; a zero byte ends the list.
    for (const char* at = voice.languages; at != nullptr && *at != '\0';) {
      wire += std::string(at + 1) + '\0';
      at += std::strlen(at + 1) + 2;
    }
    if (!sender.send(kVoice, wire)) return false;
  }
  espeak_VOICE wanted{};
  wanted.languages = "variant";
  list = espeak_ListVoices(&wanted);
  for (; list != nullptr && *list != nullptr; ++list) {
    if (!sender.send(kVariant, (*list)->identifier)) return false;
  }
  return true;
}

VoiceEvent unpack(const WireEvent& wire) {
  VoiceEvent event;
  event.kind = wire.kind == 0   ? EventKind::word
               : wire.kind == 2 ? EventKind::mark
                                : EventKind::phoneme;
  event.sample = wire.sample;
  event.text_position = wire.text_position;
  event.text_length = wire.text_length;
  if (event.kind != EventKind::word) {
    event.ipa.assign(wire.name, ::strnlen(wire.name, sizeof wire.name));
  }
  return event;
}

void append_samples(std::vector<std::int16_t>& samples, const std::string& bytes) {
  const std::size_t before = samples.size(), count = bytes.size() / sizeof(std::int16_t);
  samples.resize(before + count);
  std::memcpy(samples.data() + before, bytes.data(), count * sizeof(std::int16_t));
}

VoiceInfo unpack_voice(const std::string& bytes) {
  std::vector<std::string> fields;
  for (std::size_t at = 0; at < bytes.size();) {
    fields.emplace_back(bytes.c_str() + at);
    at += fields.back().size() + 1;
  }
  VoiceInfo voice;
  if (fields.size() < 3) return voice;
  voice.name = fields[0];
  voice.identifier = fields[1];
  voice.language = fields[2];
  voice.other_languages.assign(fields.begin() + 3, fields.end());
  return voice;
}

}  // namespace

Result<EspeakResult> run_espeak(const EspeakJob& job) {
  EspeakResult result;
  std::string failure;
  std::size_t total = 0;
  bool too_long = false;
  result.speech.emplace_back();
  const auto receive = [&](std::uint32_t tag, std::string bytes) {
    if (tag == kFailure) failure = std::move(bytes);
    if (tag == kSampleRate && bytes.size() == sizeof(std::int32_t)) {
      std::memcpy(&result.sample_rate, bytes.data(), bytes.size());
    }
    if (tag == kTextEnd) result.speech.emplace_back();
    if (tag == kSamples) {
      append_samples(result.speech.back().samples, bytes);
      total += bytes.size() / sizeof(std::int16_t);
    }
    if (tag == kEvents && bytes.size() == sizeof(WireEvent)) {
      WireEvent wire;
      std::memcpy(&wire, bytes.data(), sizeof wire);
      result.speech.back().events.push_back(unpack(wire));
    }
    too_long = std::int64_t(total) > job.max_seconds * std::max(result.sample_rate, 1);
    return !too_long;
  };
  const auto run = run_child(
      "espeak-ng", 300, [&](Sender& sender) { return speak_all(sender, job); }, receive);
  if (too_long) {
    return make_error(Code::out_of_range, "the text makes more than " +
                                              std::to_string(job.max_seconds) +
                                              " s of speech; speak it in parts");
  }
  if (!failure.empty()) return make_error(Code::io, failure);
  if (!run) return run.error();
  result.speech.pop_back();  // opened by the last kTextEnd
  return result;
}

Result<VoiceLists> read_espeak_voices(const std::string& data_path) {
  VoiceLists lists;
  std::string failure;
  const auto receive = [&](std::uint32_t tag, std::string bytes) {
    if (tag == kFailure) failure = std::move(bytes);
    if (tag == kVoice) {
      VoiceInfo voice = unpack_voice(bytes);
      const bool usable = !voice.name.empty() && !voice.identifier.starts_with("mb/");
      if (usable) lists.voices.push_back(std::move(voice));
    }
    if (tag == kDataPath) lists.data_path = bytes;
    if (tag == kVariant) lists.variants.push_back(bytes.substr(bytes.rfind('/') + 1));
    return true;
  };
  const auto run = run_child(
      "espeak-ng", 60, [&](Sender& sender) { return send_voices(sender, data_path); }, receive);
  if (!failure.empty()) return make_error(Code::io, failure);
  if (!run) return run.error();
  return lists;
}

}  // namespace animeme::voice
