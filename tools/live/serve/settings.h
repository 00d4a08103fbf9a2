/// @file
/// Settings of a head and their JSON form; names and bounds are those of the options of
/// `animeme stream`.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dam/script/mood.h"
#include "dam/speaking/idle_motion.h"
#include "dam/speaking/synthesise.h"
#include "fap/result.h"
#include "tools/formats/common/json.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/speech/voice/voice.h"

namespace animeme::serve {

/// The comments give the JSON members.
struct HeadSettings {
  std::string model;          ///< "model": a name known to the server; empty: built-in
  voice::VoiceOptions voice;  ///< "lang", "speed" (words a minute), "pitch"
  std::string tts;            ///< "tts": a command known to the server; empty: espeak-ng
  int voice_rate = 0;         ///< "voice_rate": Hz, 8000..48000; 0: that of the voice
  std::string head;           ///< "head": a head of the page; empty: the first one
  dam::SynthesisOptions
      motion;               ///< "rate", "style", "sharpness", "articulate", "symmetric", "tongue"
  bool idle_motion = true;  ///< "idle_motion": gaze, blinks, brows and head
  /// Of the idle motion: "seed" (0..1e9), "liveliness" (0..2), "still" ("gaze,head"), "look"
  /// ("camera", "20,-5")
  dam::IdleMotionOptions idle;
  std::string over;  ///< "over": a performance known to the server, which repeats; empty: none
  std::string keep;  ///< "keep": shares of it, "lips=0.5,brows=0" (dam/performance/kept_shares.h)
  dam::Mood mood;    ///< "mood": a name of dam::read_mood(), also "joy:0.6"
  double intra_seconds = 1;  ///< "intra_seconds": interval of intra planes
  double encoder_delay = 0;  ///< "encoder_delay": seconds by which all is sent later, for less bits
  int quant = 1;             ///< "quant", 0..31
  bool sound = true;         ///< "sound"
  media::AudioSettings
      audio;  ///< "audio_codec", "audio_bitrate", "audio_effort", "audio_fec" (Opus)

  HeadSettings();  ///< Opus with an effort of 5 at 48000 bits a second, the articulation of the
                   ///< model, a tongue
};

/// Applies `json`, an object, to `settings`. Errors: invalid_argument (an unknown member or an
/// invalid value; the message names it).
Result<HeadSettings> read_settings(const tools::Json& json, HeadSettings settings);

/// What changes without an interruption: the voice (not its rate), the mood, where it looks.
/// `from` with these of `to`.
HeadSettings with_live_parts(HeadSettings from, const HeadSettings& to);

/// All members, in the format of read_settings().
tools::Json settings_json(const HeadSettings& settings);

/// Whether a name is valid for a head: 1..64 letters, digits, '-', '_' and '.', not beginning with
/// '.'.
bool is_head_name(std::string_view name);

/// Heads of a file, {"defaults": {...}, "heads": [{"name": "anna", ...}, ...]}.
struct HeadList {
  HeadSettings defaults;                                    ///< for heads created later
  std::vector<std::pair<std::string, HeadSettings>> heads;  ///< name, settings
};

/// Reads such a file. Errors: those of read_file() and read_settings(); syntax (not JSON, no such
/// list), invalid_argument (a duplicate or missing name); all have the file name.
Result<HeadList> read_head_list(const std::string& path, const HeadSettings& defaults);

}  // namespace animeme::serve
