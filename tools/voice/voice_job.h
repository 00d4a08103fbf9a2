/// @file
/// From what a user asks for to what a voice said. Internal: what voice.h and symbols.h share.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/voice/espeak_process.h"

namespace animeme::voice {

/// A voice that is installed.
struct FoundVoice {
  std::string identifier;  ///< for espeak-ng, with variant: "gmw/en-US+f3"
  std::string name;        ///< "English (America)"
  std::string file;        ///< in the folder lang of the data, without variant: "gmw/en-US"
  std::string data_path;   ///< the folder espeak-ng-data itself
};

/// The voice of VoiceOptions::language; all options are checked. Errors: those of speak_text()
/// about options and voices.
Result<FoundVoice> find_voice(const VoiceOptions& options);

/// run_espeak() with the IPA that the voice means (espeak_ipa.h).
Result<EspeakResult> run_voice(const EspeakJob& job);

}  // namespace animeme::voice
