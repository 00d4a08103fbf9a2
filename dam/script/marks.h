/// @file
/// Marks: labels that are neither words nor sounds of speech. Recognisers, aligners and
/// transcribers note with them what else is heard ("[noise]", "(laughs)", "{BR}", "*giggles*",
/// "++COUGH++"), what nobody understood ("<unk>", "<usb>", "gb"), and what they think of it
/// ("[BLANK_AUDIO]"). Readers of scripts take them for silence.
/// Source: dam/script/phoneme_scripts.md, section 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace animeme::dam {

/// Whether a label as a whole is a mark: in brackets ([ ( { <), in stars, between plus signs, or a
/// name that is no word of any language ("spn", "gb"). False for pauses (is_silence_spelling() of
/// dam/script/phones.h), which nobody takes for words, and for single characters, which are
/// phonemes of X-SAMPA.
bool is_mark(std::string_view label);

/// The same among phones, where the names of sounds that people make are no words either: "noise",
/// "LAUGH", "breath", "fp", "@@", "unknown".
bool is_mark_among_phones(std::string_view label);

/// Where a text is from, which decides what its brackets hold.
enum class MarksOf : std::uint8_t {
  captions,  ///< subtitles, labels: what is in brackets is not said
  prose,     ///< a text to be said: "(my dog)" is, "(laughs)" and "[sighs]" are not; nor is what
             ///< stands in square brackets before or after a sentence, whatever its language
};

/// A text without its marks.
struct Unmarked {
  std::string text;       ///< with one blank, or none before punctuation, for a mark between blanks
  std::string mark;       ///< the first one, with its brackets; empty: there is none
  std::size_t count = 0;  ///< of marks
};

/// Takes the marks out of a text in UTF-8. What is in stars is a mark if it names a sound that
/// people make ("*giggles*", not "*really*"); an unpaired bracket is an ordinary character.
Unmarked without_marks(std::string_view text, MarksOf from);

}  // namespace animeme::dam
