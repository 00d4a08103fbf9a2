/// @file
/// From what a user asks for to what a voice said. Internal: what voice.h and symbols.h share.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/speech/text/utterance.h"
#include "tools/speech/voice/espeak_process.h"

namespace animeme::voice {

/// A voice that is installed.
struct FoundVoice {
  std::string identifier;  ///< for espeak-ng, with variant: "gmw/en-US+f3"
  std::string name;        ///< "English (America)"
  std::string language;    ///< "en-us"
  std::string file;        ///< in the folder lang of the data, without variant: "gmw/en-US"
  std::string data_path;   ///< the folder espeak-ng-data itself
};

/// The voice of VoiceOptions::language; all options are checked. Errors: those of speak_text()
/// about options and voices.
Result<FoundVoice> find_voice(const VoiceOptions& options);

/// The voices of VoiceOptions::language for a text, which "auto" asks for its scripts; all options
/// are checked. Errors as find_voice().
Result<text::Speakers> find_speakers(const VoiceOptions& options, std::u32string_view text);

/// What make_utterance() asks for.
text::Helpers helpers_of(const VoiceOptions& options);

/// run_espeak() with the IPA that the voice means (espeak_ipa.h), where there is one voice.
Result<EspeakResult> run_voice(const EspeakJob& job);

}  // namespace animeme::voice
