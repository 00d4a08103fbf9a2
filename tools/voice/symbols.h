/// @file
/// What a voice can say, and which phones are spoken for it.
#pragma once

#include <string>
#include <vector>

#include "dam/script/ipa.h"
#include "fap/result.h"
#include "tools/voice/voice.h"

namespace animeme::voice {

/// A phoneme of a voice.
struct VoiceSymbol {
  std::string mnemonic;   ///< espeak-ng's name for it: "tS", "u:"
  std::string ipa;        ///< what the voice means by it; empty: a mark without a sound of its own
  bool bilabial = false;  ///< espeak-ng calls it a consonant of both lips
  bool known = true;      ///< false: a letter of `ipa` is in no table, AX is spoken
  std::vector<dam::IpaSound> sounds;  ///< the phones that are spoken
};

/// All symbols of a voice: the phonemes of its table in espeak-ng-data, those that it shares with
/// other languages included, each spoken by itself, so that IPA is what events of speech would say.
/// Errors: those of speak_text(); not_found, truncated, syntax (data of another version).
Result<std::vector<VoiceSymbol>> voice_symbols(const VoiceOptions& options = {});

/// How the symbols of a voice are spoken.
struct SymbolCounts {
  std::size_t exact = 0;                 ///< letters of the phones that models know
  std::size_t features = 0;              ///< the phone that looks most alike, or several
  std::size_t marks = 0;                 ///< without a sound of their own
  std::size_t unknown = 0;               ///< a letter is in no table
  std::size_t bilabial = 0, closed = 0;  ///< espeak-ng's bilabials; of them those with P B M
  std::size_t round = 0, rounded = 0;    ///< rounded vowels; of them those with a rounded phone
  std::size_t flat = 0, unrounded = 0;   ///< ɨ ɯ; of them those whose phones are all unrounded

  /// Adds those of another voice.
  SymbolCounts& operator+=(const SymbolCounts& other);
};

/// Counts.
SymbolCounts count_symbols(const std::vector<VoiceSymbol>& symbols);

}  // namespace animeme::voice
