/// @file
/// espeak-ng's compiled table of phonemes: what a voice can say. Internal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::voice {

/// A phoneme of a voice.
struct PhonemeName {
  std::string mnemonic;   ///< as [[...]] speaks it, up to four bytes
  bool bilabial = false;  ///< a consonant that is made with both lips, as espeak-ng has it
};

/// The phonemes of table `name` with those of the tables that it stands on, by their codes; pauses,
/// stresses and what stands for another phoneme are left out. `bytes` is the file phontab of
/// espeak-ng-data 1.51: a byte that counts tables and three more, then for each table a byte that
/// counts phonemes, one with the table below (from 1, 0: none), two more, 32 bytes of name, and 16
/// bytes a phoneme: mnemonic, u32 flags (bits 16 to 19: place, 1 is bilabial), u16, u8 code, u8
/// type, four more. Errors: not_found (no such table), truncated, syntax.
Result<std::vector<PhonemeName>> read_phoneme_table(std::string_view bytes, std::string_view name);

/// The name of the table of a voice, by the text of its file in espeak-ng-data/lang: what its line
/// "phonemes" says, else its first "language". Empty: it has neither.
std::string phoneme_table_name(std::string_view voice_file);

}  // namespace animeme::voice
