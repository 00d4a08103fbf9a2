/// @file
/// The moods that a text shows: by emoji, by classic smileys (":-)") and by exclamation marks.
///
/// An emoji with a mood is for the words in front of it, back to the end of a sentence or another
/// emoji; at the start of a line, for those behind it. A clause that ends with an exclamation mark
/// intensifies whatever mood is there, by a fifth, and alone changes nothing.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "dam/script/mood.h"
#include "dam/script/script.h"
#include "tools/speech/text/spoken_text.h"

namespace animeme::text {

/// A range of a text and its mood; see dam::MoodSpan.
struct MoodPlace {
  Place place;                    ///< code points of the text as written
  std::optional<dam::Mood> mood;  ///< nullopt: that of what is around it
  double gain = 1;                ///< multiplies the intensity, 0..2
  friend bool operator==(const MoodPlace&, const MoodPlace&) = default;
};

/// What an emoji or a smiley means ("😢", ":-("); nullopt: no mood.
std::optional<dam::Mood> mood_of_emoji(std::u32string_view emoji);

/// The moods in a text, in order.
std::vector<MoodPlace> find_moods(std::u32string_view text);

/// The same for a text (UTF-8) that a script with words speaks: by the times of these words.
std::vector<dam::MoodSpan> find_moods(std::string_view text, const dam::Script& script);

/// Turns smileys of letters and signs into blanks, so that no voice reads them. Emoji stay, which
/// read_written() removes.
void blank_smileys(SpokenText& said);

/// A word of a text and the time at which it begins.
struct TimedPlace {
  std::uint32_t place = 0;  ///< code point at which it begins
  double start = 0;         ///< seconds
};

/// Places as times. `words` are in order of time; `end` is the end of the speech, in seconds.
std::vector<dam::MoodSpan> mood_spans(const std::vector<MoodPlace>& places,
                                      const std::vector<TimedPlace>& words, double end);

}  // namespace animeme::text
