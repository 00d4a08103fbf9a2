/// @file
/// A phoneme script: which sound is spoken when. Output of aligners and TTS engines, input of
/// training and synthesis.
///
///     auto script = animeme::dam::read_script(text);
///     if (!script) std::cerr << std::move(script).error().in_file(path).describe();
///
/// Supported formats, detected by their content (dam/script/phoneme_scripts.md, section 1, has all
/// of them with their units):
///
/// - TSV, Animeme's own: tab separated, a header line that names the columns in any order: start_s
///   (or start), end_s (or end) or duration_s (or duration), phone (or phoneme, label) or word, or
///   both. Other columns are ignored, and so are lines that begin with #.
///
///       start_s	end_s	phone	word
///       0	0.21	SIL
///       0.21	0.25	B	bin
///
/// - TextGrid: Praat's text form, long or short. The tier named phones, phone, phonemes, MAU,
///   PhonAlign or "NAME - phones" (any case) gives the phones; the tier words, word, ORT-MAU,
///   TokensAlign or "NAME - words", if there is one, the words. An only tier is read in any case.
/// - Label files: HTK (.lab, .mlf), Festival and ESPS (.lab), TIMIT (.phn, .wrd), Audacity, lines
///   of start, end and label; MBROLA (.pho); CTM; PocketSphinx (.phseg); flite; Montreal aligner
///   (.csv); Rhubarb Lip Sync (.tsv, .xml), Moho (.dat) and Papagayo (.pgo), whose mouths become
///   phones; SubRip, WebVTT, SubViewer, TTML, ASS; lyrics (.lrc).
///
/// Text is UTF-8, UTF-16 with or without a byte order mark, or else Windows-1252. JSON (Montreal
/// aligner, Gentle, WhisperX, speech services) is read by tools/formats/scripts/script_text.h.
///
/// Source: dam/script/phoneme_scripts.md, sections 1 and 3.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::dam {

/// How the word of a phone relates to the word before it. Usually a word is what phones in a row
/// have in common; two cases differ.
enum class WordLink : std::uint8_t {
  automatic,  ///< a new word if its text differs from that of the previous phone, or after a pause
  again,      ///< a new word with the text of the previous phone: the second "no" of "no no"
  continued,  ///< after a pause, the same word as before it: "12,50 EUR", said with a pause inside
};

/// One spoken sound. `label` is upper-case ARPAbet without stress digits ("AA", "P") or "SIL".
struct Phone {
  double start = 0;                     ///< seconds from the start of the audio
  double end = 0;                       ///< seconds, > start
  std::string label;                    ///< ARPAbet without stress, or SIL
  std::string word;                     ///< the word it belongs to; empty: unknown or silence
  WordLink link = WordLink::automatic;  ///< of `word` to the word before; see words_of()

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

/// The notation of labels.
enum class Alphabet : std::uint8_t {
  automatic,  ///< IPA if more labels can only be IPA or X-SAMPA than can only be ARPAbet
  arpabet,    ///< AA, aa, AA1 ...; see arpabet_label() in dam/script/phones.h
  ipa,        ///< IPA or X-SAMPA, see dam/script/ipa.h
};

/// The content of labels.
enum class LabelUnit : std::uint8_t {
  automatic,  ///< by format; if it allows both, words if most labels can only be words
  phones,     ///< sounds
  words,      ///< words, whose phones are not in the file
};

/// Options of read_script(). Values that are empty or 0 are detected from the content.
struct ScriptOptions {
  Alphabet alphabet = Alphabet::automatic;  ///< of the labels
  /// The name of the tier to read (TextGrid, Montreal aligner; in any case) or its number from 1,
  /// or the exact name of the recording if a file holds several (HTK .mlf, CTM). Empty: chosen by
  /// the names above, or the only one.
  std::string tier;
  std::string format;                     ///< a name of text_script_formats() (timings.h)
  LabelUnit unit = LabelUnit::automatic;  ///< of the labels
  /// Time units per second in the file, > 0, for formats that count: 16000 (samples of TIMIT), 100
  /// (frames of PocketSphinx), 24 (frames of Moho), 10000000 (HTK). 0: these defaults.
  double rate = 0;
  /// Whose words are read where a file tells speakers apart (WebVTT, TextGrids of several speakers,
  /// channels of a CTM, recognisers), in any case. Empty: those of all.
  std::string speaker;
  /// Marks such as "[noise]" (dam/script/marks.h) are words, too; else they are silence.
  bool speak_marks = false;
  /// What several say at the same time stays as it is: labels of speakers overlap, and TextGrids
  /// give the tiers of all. For who asks who speaks; make_script() takes one speaker.
  bool everyone = false;
};

/// Something in a file that was left out, or read as something else than it says; one of a kind.
struct ScriptNote {
  /// What was done.
  enum class Kind : std::uint8_t {
    marks,         ///< marks became silence
    no_time,       ///< labels that take no time were left out
    overlaps,      ///< words were cut, where the next begin before they end
    milliseconds,  ///< times were taken for milliseconds
    long_labels,   ///< words last so long that their times may be in another unit
    counts,        ///< a TextGrid holds more or less than it says
    given_times,   ///< words without times, or with an end before their start, got some
    odd_bytes,     ///< bytes that are not UTF-8 in a text that is
  };
  Kind kind = Kind::marks;  ///< what was done
  std::string message;      ///< one sentence without a full stop, about the first of them
  std::size_t count = 0;    ///< how many of them there are
  std::int64_t line = 0;    ///< of the first one, from 1; 0: unknown

  /// "line 5: MESSAGE (3 in all)".
  std::string describe() const;
  friend bool operator==(const ScriptNote&, const ScriptNote&) = default;
};

/// Reads a script in any format of the list above.
///
/// The result begins at 0, has no gaps (they become SIL) and no two SIL in a row, and every label
/// is one of the 41 of dam/script/phones.h. SIL has no word. An IPA label for which ARPAbet needs
/// two phones ("ts") becomes two phones that share its time; one without a sound of its own (a lone
/// length mark) lengthens the previous phone. Marks are silence, labels that take no time are left
/// out, words end where the next begin, and those that end before they begin last as long as they
/// take to say; `notes`, if not null, receives what was done of this.
///
/// Errors, with line and column: syntax (unknown format, missing column or tier, an invalid number,
/// phones that overlap by more than kTimeTolerance or run backwards, a phone with end < start, a
/// negative time),
/// not_found (unknown label; no such tier or recording), out_of_range (infinite times, beyond
/// kMaxScriptSeconds), truncated (an empty file, or one that ends early), unsupported (a binary
/// TextGrid; words without phones), invalid_argument (no such format, a rate that is not a number
/// above 0).
Result<Script> read_script(std::string_view text, const ScriptOptions& options = {},
                           std::vector<ScriptNote>* notes = nullptr);

/// TSV with the header "start_s end_s phone word". Times have enough digits to restore the same
/// numbers. Tabs and line ends inside words become spaces. A script that read_script() returned is
/// restored exactly.
std::string write_script_tsv(const Script& script);

/// Praat TextGrid, long form, UTF-8, tiers "words" and "phones"; silence has empty text. Lossless
/// like write_script_tsv().
std::string write_textgrid(const Script& script);

/// MBROLA's .pho: a phone and its milliseconds per line, "_" is silence. The labels are ARPAbet,
/// which MBROLA has to be configured for (its option -C); words are lost. Reading restores the
/// labels, and times within a microsecond.
std::string write_pho(const Script& script);

/// WebVTT: captions (dam/script/captions.h) with the time of each word; phones are lost. If no word
/// is known the phones are shown. Reading restores words with times within a millisecond.
std::string write_webvtt(const Script& script);

/// SubRip: the same captions, without the times of words.
std::string write_srt(const Script& script);

/// The file extensions that write_script() supports, such as ".tsv".
std::vector<std::string> script_endings();

/// Writes the format of a file extension in any case: .TextGrid, .tsv, .pho, .vtt, .srt; a TextGrid
/// for any other.
std::string write_script(const Script& script, std::string_view ending);

/// Checks the guarantees of read_script(), for scripts of other origin: times finite, ascending and
/// without overlap beyond kTimeTolerance, known labels, not empty.
/// Error: invalid_argument with the number of the phone (from 1) in the message, or truncated.
Result<void> check_script(const Script& script);

/// Fails (out_of_range) if the audio ends more than 50 ms before the last sound of the script, not
/// counting silence after it. Longer audio is fine: the rest is silence.
Result<void> check_against_audio(const Script& script, double audio_seconds);

}  // namespace animeme::dam
