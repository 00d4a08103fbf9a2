/// @file
/// Sound of somebody else's voice becomes speech: with the times that came with it, or with those
/// that alignment finds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/formats/media/pcm.h"
#include "tools/speech/talking/voice_file.h"
#include "tools/speech/voice/align.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {

/// Where the times of phones come from.
enum class TimesFrom : std::uint8_t {
  voice,      ///< the voice that made the sound told them
  script,     ///< a script with phones, or with visemes
  words,      ///< a script with words: phones inside a word are a guess
  alignment,  ///< a recording was aligned with its text
  sound,      ///< they were recognised in a recording, without a text
};

/// "voice", "script", "words", "alignment" or "sound".
const char* name_of(TimesFrom times);

/// A sound and what is known of it.
struct TimedSound {
  media::Pcm audio;    ///< without samples: times alone, which somebody else gives the sound to
  std::string text;    ///< what is said; may be empty where there are labels
  std::string labels;  ///< a script of any format; empty: by alignment of the text
  std::string from;    ///< where the labels are from, for messages
  bool labels_may_be_none = false;  ///< labels that are no script are passed over, with a sentence
};

/// Speech with what is known about its times.
struct TimedSpeech {
  voice::Speech speech;                       ///< its script covers the audio
  TimesFrom times = TimesFrom::voice;         ///< source of the script
  std::optional<voice::Alignment> alignment;  ///< where it was aligned; without its script
};

/// Speech of a sound. The script is made as long as the audio. Errors: those of parse_script(),
/// dam::check_against_audio() and voice::align(); invalid_argument (neither labels nor text).
Result<TimedSpeech> time_sound(TimedSound sound, const ScriptInput& input,
                               const tools::Log& log = {});

}  // namespace animeme::speech
