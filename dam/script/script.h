/// @file
/// A phoneme script: which sound is spoken when. What aligners and voices make, what training
/// and synthesis take.
///
///     auto script = animeme::dam::read_script(text);
///     if (!script) std::cerr << std::move(script).error().in_file(path).describe();
///
/// Formats read, told apart by their content:
///
/// - TSV: tab separated, a header line that names the columns in any order: start_s (or start),
/// end_s
///   (or end) or duration_s (or duration), phone (or phoneme, label), optionally word. Other
///   columns are ignored, lines that begin with # too.
///
///       start_s	end_s	phone	word
///       0	0.21	SIL
///       0.21	0.25	B	bin
///
/// - TextGrid: Praat's text form, long or short, UTF-8 or UTF-16 with a byte order mark. The tier
///   named phones, phone, phonemes or "NAME - phones" (any case) gives the phones; the tier words,
///   word or "NAME - words", if there is one, the words.
///
/// Source: dam/script/phoneme_scripts.md, sections 1 and 3.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::dam {

/// One spoken sound. `label` is upper-case ARPAbet without stress digits ("AA", "P") or "SIL".
struct Phone {
  double start = 0;   ///< seconds from the start of the audio
  double end = 0;     ///< seconds, > start
  std::string label;  ///< ARPAbet without stress, or SIL
  std::string word;   ///< the word it belongs to; empty: unknown or silence

  double duration() const { return end - start; }  ///< seconds, > 0
  friend bool operator==(const Phone&, const Phone&) = default;
};

/// Phones in time order without overlap. Gaps are silence.
struct Script {
  std::vector<Phone> phones;  ///< ascending

  /// End of the last phone in seconds, 0 if there is none.
  double duration() const { return phones.empty() ? 0.0 : phones.back().end; }
  friend bool operator==(const Script&, const Script&) = default;
};

inline constexpr std::string_view kSilence = "SIL";  ///< the label of silence

/// Phones may overlap or leave a gap by this much (seconds): files round their times.
inline constexpr double kTimeTolerance = 0.001;
/// Scripts longer than this (seconds, one day) are refused.
inline constexpr double kMaxScriptSeconds = 86400.0;

/// The letters that labels are written in.
enum class Alphabet : std::uint8_t {
  automatic,  ///< IPA if more labels can only be IPA or X-SAMPA than can only be ARPAbet
  arpabet,    ///< AA, aa, AA1 ...; see arpabet_label() in dam/script/phones.h
  ipa,        ///< IPA or X-SAMPA, see dam/script/ipa.h
};

/// What read_script() is told of a file.
struct ScriptOptions {
  Alphabet alphabet = Alphabet::automatic;  ///< of the labels
  /// TextGrid: the exact name of the tier to read. Empty: chosen by the names above.
  std::string tier;
};

/// Reads a script in any format of the list above.
///
/// The result begins at 0, is without gaps (they become SIL), has no two SIL in a row, and every
/// label is one of the 41 of dam/script/phones.h. SIL has no word. An IPA label that ARPAbet needs
/// two phones for ("ts") becomes two phones that share its time; one that stands for no sound of
/// its own (a lone length mark) lengthens the phone before it.
///
/// Errors, with the line: syntax (unknown format, missing column or tier, a field that is no
/// number, phones that overlap by more than kTimeTolerance or run backwards, end <= start, a
/// negative time), not_found (unknown label; no such tier), out_of_range (infinite times, beyond
/// kMaxScriptSeconds), truncated (nothing in it, or the file ends early), unsupported (a binary
/// TextGrid).
Result<Script> read_script(std::string_view text, const ScriptOptions& options = {});

/// TSV with the header "start_s end_s phone word". Times are written with as many digits as it
/// takes to read back the same numbers. Tabs and line ends inside words become spaces. A script
/// that read_script() returned reads back equal.
std::string write_script_tsv(const Script& script);

/// Praat TextGrid, long form, UTF-8, tiers "words" and "phones"; silence has empty text. Reads
/// back equal as write_script_tsv() does.
std::string write_textgrid(const Script& script);

/// Tests what read_script() promises of its result, for scripts that come from elsewhere: times
/// finite, ascending and without overlap beyond kTimeTolerance, known labels, not empty.
/// Error: invalid_argument with the number of the phone (from 1) in the message, or truncated.
Result<void> check_script(const Script& script);

/// Fails (out_of_range) if the audio is more than 50 ms shorter than the script. Longer audio is
/// fine: the rest is silence.
Result<void> check_against_audio(const Script& script, double audio_seconds);

}  // namespace animeme::dam
