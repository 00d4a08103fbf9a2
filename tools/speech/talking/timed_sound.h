/// @file
/// Turns external sound into speech, with given timings or by alignment.
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

/// Source of phone timings.
enum class TimesFrom : std::uint8_t {
  voice,      ///< from the synthetic voice
  script,     ///< a script with phones, or with visemes
  words,      ///< a script with words: phones inside a word are estimated
  alignment,  ///< a recording was aligned with its text
  sound,      ///< recognised in a recording, without a text
};

/// "voice", "script", "words", "alignment" or "sound".
const char* name_of(TimesFrom times);

/// A sound with its known properties.
struct TimedSound {
  media::Pcm audio;                 ///< without samples: only timings, with sound from elsewhere
  std::string text;                 ///< what is said; may be empty with labels
  std::string labels;               ///< a script of any format; empty: align the text
  std::string from;                 ///< origin of the labels, for messages
  bool labels_may_be_none = false;  ///< ignore labels that are not a script, with a warning
};

/// Speech with the source of its timings.
struct TimedSpeech {
  voice::Speech speech;                       ///< its script covers the audio
  TimesFrom times = TimesFrom::voice;         ///< source of the script
  std::optional<voice::Alignment> alignment;  ///< if aligned; without its script
};

/// Converts a sound to speech. The script is extended to the length of the audio. Errors: those of
/// parse_script(), dam::check_against_audio() and voice::align(); invalid_argument (neither labels
/// nor text).
Result<TimedSpeech> time_sound(TimedSound sound, const ScriptInput& input,
                               const tools::Log& log = {});

}  // namespace animeme::speech
