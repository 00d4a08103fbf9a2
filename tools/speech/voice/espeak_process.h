/// @file
/// espeak-ng in a child process. Internal: voice.h is the interface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {

/// What the voice announces.
enum class EventKind : std::uint8_t { word, phoneme, mark };

/// What happens at one sample of the sound.
struct VoiceEvent {
  /// what it is
  EventKind kind = EventKind::phoneme;
  std::int64_t sample = 0;         ///< when, from the start of the sound
  std::int32_t text_position = 0;  ///< word: first character of it in the text, from 1
  std::int32_t text_length = 0;    ///< word: in characters
  std::string ipa;  ///< phoneme: at most 8 bytes as espeak-ng has it, may end in half a
                    ///< character. mark: its name, at most 7 bytes
};

/// Sound and events of one text.
struct RawSpeech {
  std::vector<bool> silent;                ///< one for each sample: nothing is to be heard
  std::vector<VoiceEvent> events;          ///< ascending
  std::vector<std::int16_t> samples = {};  ///< mono, full scale +-32768; none with EspeakJob::sink
};

/// What the child is to say.
struct EspeakJob {
  std::string voice;                ///< identifier, with variant
  std::vector<std::string> texts;   ///< UTF-8 without NUL, spoken one after the other
  VoiceOptions options;             ///< rate, pitch, range, gap, data path
  bool mnemonics = false;           ///< texts name phonemes in [[ ]]
  bool markup = false;              ///< texts are SSML; positions count its characters, too
  std::int64_t max_seconds = 3600;  ///< of sound, all texts together
  SoundSink sink;                   ///< receives the sound; empty: RawSpeech::samples
};

/// What the child said.
struct EspeakResult {
  int sample_rate = 0;            ///< Hz
  std::vector<RawSpeech> speech;  ///< one for each text
};

/// Errors: unsupported, io, out_of_range (more than max_seconds), those of `sink`.
Result<EspeakResult> run_espeak(const EspeakJob& job);

/// What is installed.
struct VoiceLists {
  std::vector<VoiceInfo> voices;      ///< languages and dialects
  std::vector<std::string> variants;  ///< "f3", "croak" ...
  std::string data_path;              ///< the folder espeak-ng-data
};

/// Errors: unsupported, io.
Result<VoiceLists> read_espeak_voices(const std::string& data_path);

}  // namespace animeme::voice
