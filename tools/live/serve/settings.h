/// @file
/// What a head is like, and how that is written in JSON: names and bounds are those of the options
/// of `animeme stream`.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dam/speaking/synthesise.h"
#include "fap/result.h"
#include "tools/formats/common/json.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/speech/voice/voice.h"

namespace animeme::serve {

/// The members of its JSON stand beside.
struct HeadSettings {
  std::string model;             ///< "model": a name that the server was started with; empty: ours
  voice::VoiceOptions voice;     ///< "lang", "speed" (words a minute), "pitch"
  dam::SynthesisOptions motion;  ///< "rate", "style", "sharpness", "articulate"
  bool idle_motion = true;       ///< "idle_motion": blinks, and brows and head that move a little
  std::uint64_t seed = 1;        ///< "seed" of idle motion, 0..1e9
  double intra_seconds = 1;      ///< "intra_seconds": between planes with which decoders can begin
  int quant = 1;                 ///< "quant", 0..31
  bool sound = true;             ///< "sound"
  media::AudioSettings audio;    ///< "audio_codec", "audio_bitrate", "audio_effort" (Opus)

  HeadSettings();  ///< Opus with an effort of 5 at 48000 bits a second, articulation 1
};

/// `json`, an object, over `settings`. Errors: invalid_argument (a member that nobody knows, or
/// with a value that it cannot have; the sentence names it).
Result<HeadSettings> read_settings(const tools::Json& json, HeadSettings settings);

/// All members, as read_settings() reads them.
tools::Json settings_json(const HeadSettings& settings);

/// A name that a head can have: 1..64 letters, digits, '-', '_' and '.', not in front.
bool is_head_name(std::string_view name);

/// Heads of a file, {"defaults": {...}, "heads": [{"name": "anna", ...}, ...]}.
struct HeadList {
  HeadSettings defaults;                                    ///< of heads that are made later
  std::vector<std::pair<std::string, HeadSettings>> heads;  ///< name, settings
};

/// Reads such a file. Errors: those of read_file() and read_settings(); syntax (no JSON, no such
/// list), invalid_argument (a name twice, or none); all name the file.
Result<HeadList> read_head_list(const std::string& path, const HeadSettings& defaults);

}  // namespace animeme::serve
