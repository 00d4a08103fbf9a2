/// @file
/// A phoneme script: which sound is spoken when. What aligners and voices make, what training
/// and synthesis take.
///
///     auto script = animeme::dam::read_script(text);
///     if (!script) std::cerr << std::move(script).error().in_file(path).describe();
///
/// Formats read, told apart by their content (dam/script/phoneme_scripts.md, section 1, has all of
/// them with their units):
///
/// - TSV, our own: tab separated, a header line that names the columns in any order: start_s (or
///   start), end_s (or end) or duration_s (or duration), phone (or phoneme, label) or word, or
///   both. Other columns are ignored, lines that begin with # too.
///
///       start_s	end_s	phone	word
///       0	0.21	SIL
///       0.21	0.25	B	bin
///
/// - TextGrid: Praat's text form, long or short. The tier named phones, phone, phonemes or "NAME -
///   phones" (any case) gives the phones; the tier words, word or "NAME - words", if there is one,
///   the words.
/// - Label files: HTK (.lab, .mlf), Festival and ESPS (.lab), TIMIT (.phn, .wrd), Audacity, lines
/// of
///   start, end and label; MBROLA (.pho); CTM; PocketSphinx (.phseg); flite; Montreal aligner
///   (.csv);
///   Rhubarb Lip Sync (.tsv, .xml) and Moho (.dat), whose mouths become phones; SubRip and WebVTT.
///
/// Text is UTF-8, UTF-16 with or without a byte order mark, or else Latin-1. What JSON there is
/// (Montreal aligner, Gentle, WhisperX, speech services) reads tools/formats/scripts/script_text.h.
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

/// What the labels of a file are.
enum class LabelUnit : std::uint8_t {
  automatic,  ///< what the format says; where it may hold both, words if most labels can only be
              ///< words
  phones,     ///< sounds
  words,      ///< words, whose phones are not in the file
};

/// What read_script() is told of a file. What is empty or 0 is told by the content.
struct ScriptOptions {
  Alphabet alphabet = Alphabet::automatic;  ///< of the labels
  /// The exact name of the tier to read (TextGrid, Montreal aligner), or of the recording, where a
  /// file holds several (HTK .mlf, CTM). Empty: chosen by the names above, or the only one.
  std::string tier;
  std::string format;                     ///< a name of text_script_formats() (timings.h)
  LabelUnit unit = LabelUnit::automatic;  ///< of the labels
  /// Times a second that the numbers of the file count, > 0, where they count: 16000 (samples of
  /// TIMIT), 100 (frames of PocketSphinx), 24 (frames of Moho), 10000000 (HTK). 0: these.
  double rate = 0;
};

/// Reads a script in any format of the list above.
///
/// The result begins at 0, is without gaps (they become SIL), has no two SIL in a row, and every
/// label is one of the 41 of dam/script/phones.h. SIL has no word. An IPA label that ARPAbet needs
/// two phones for ("ts") becomes two phones that share its time; one that stands for no sound of
/// its own (a lone length mark) lengthens the phone before it.
///
/// Errors, with line and column: syntax (unknown format, missing column or tier, a field that is no
/// number, phones that overlap by more than kTimeTolerance or run backwards, end <= start, a
/// negative time), not_found (unknown label; no such tier or recording), out_of_range (infinite
/// times, beyond kMaxScriptSeconds), truncated (nothing in it, or the file ends early), unsupported
/// (a binary TextGrid; words without phones), invalid_argument (no such format, a rate that is no
/// number above 0).
Result<Script> read_script(std::string_view text, const ScriptOptions& options = {});

/// TSV with the header "start_s end_s phone word". Times are written with as many digits as it
/// takes to read back the same numbers. Tabs and line ends inside words become spaces. A script
/// that read_script() returned reads back equal.
std::string write_script_tsv(const Script& script);

/// Praat TextGrid, long form, UTF-8, tiers "words" and "phones"; silence has empty text. Reads
/// back equal as write_script_tsv() does.
std::string write_textgrid(const Script& script);

/// MBROLA's .pho: a phone and its milliseconds a line, "_" is silence. The labels are ARPAbet,
/// which a voice of MBROLA has to be told (its option -C); words are lost. Reads back with the same
/// labels and times within a microsecond.
std::string write_pho(const Script& script);

/// WebVTT: a cue for what is said between two pauses, with the time of each word; phones are lost.
/// Where no word is known the phones are shown. Words read back with times within a millisecond.
std::string write_webvtt(const Script& script);

/// The endings that write_script() knows, as ".tsv".
std::vector<std::string> script_endings();

/// The format of an ending in any case: .TextGrid, .tsv, .pho, .vtt; a TextGrid for any other.
std::string write_script(const Script& script, std::string_view ending);

/// Tests what read_script() promises of its result, for scripts that come from elsewhere: times
/// finite, ascending and without overlap beyond kTimeTolerance, known labels, not empty.
/// Error: invalid_argument with the number of the phone (from 1) in the message, or truncated.
Result<void> check_script(const Script& script);

/// Fails (out_of_range) if the audio ends more than 50 ms before the last sound of the script, the
/// silence behind it not counted. Longer audio is fine: the rest is silence.
Result<void> check_against_audio(const Script& script, double audio_seconds);

}  // namespace animeme::dam
