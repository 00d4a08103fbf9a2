/// @file
/// The symbols of a voice and the phones that they map to.
#pragma once

#include <string>
#include <vector>

#include "dam/script/ipa.h"
#include "fap/result.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {

/// A phoneme of a voice.
struct VoiceSymbol {
  std::string mnemonic;  ///< espeak-ng's name for it: "tS", "u:"
  /// What the voice means by it, by itself or, where the end of a word changes it (German b), in
  /// front of another sound; empty: a mark without a sound of its own.
  std::string ipa;
  bool bilabial = false;              ///< espeak-ng calls it a consonant of both lips
  bool known = true;                  ///< false: a letter of `ipa` is in no table, AX is spoken
  std::vector<dam::IpaSound> sounds;  ///< the phones that are spoken
};

/// All symbols of a voice: the phonemes of its table in espeak-ng-data, those that it shares with
/// other languages included, each spoken, so that IPA is what events of speech would say.
/// Errors: those of speak_text(); not_found, truncated, syntax (data of another version).
Result<std::vector<VoiceSymbol>> voice_symbols(const VoiceOptions& options = {});

/// IPA as the names of phonemes of a voice, for [[ ]] of espeak-ng: the longest ones that fit, left
/// to right, and the nearest sound for a letter that the voice does not have. `replaced`, if not
/// null, receives these, "ɝ as ɜː", and what is no sound at all. Empty if there is no sound in it.
std::string mnemonics_of(const std::string& voice, std::string_view ipa,
                         const VoiceOptions& options, std::vector<std::string>* replaced = nullptr);

/// How the symbols of a voice are spoken.
struct SymbolCounts {
  std::size_t exact = 0;      ///< letters of the phones that models know
  std::size_t features = 0;   ///< the phone that looks most alike, or several
  std::size_t marks = 0;      ///< without a sound of their own
  std::size_t unknown = 0;    ///< a letter is in no table
  std::size_t bilabial = 0;   ///< espeak-ng calls them consonants of both lips
  std::size_t closed = 0;     ///< of those: P, B or M is spoken
  std::size_t round = 0;      ///< rounded vowels
  std::size_t rounded = 0;    ///< of those: a rounded phone is spoken
  std::size_t flat = 0;       ///< ɨ and ɯ
  std::size_t unrounded = 0;  ///< of those: no rounded phone is spoken
};

/// Adds those of another voice.
void add_counts(const SymbolCounts& more, SymbolCounts& all);

/// Counts.
SymbolCounts count_symbols(const std::vector<VoiceSymbol>& symbols);

}  // namespace animeme::voice
