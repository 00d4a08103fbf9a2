/// @file
/// When the sounds of an utterance are spoken, as far as a speech service has told so far.
///
///     UtteranceTimes times;
///     times.add(script, 0);              // words that came with the first piece of sound
///     times.add(more, 1.2);              // ... counted from 1.2 s on
///     auto script = times.between(1.2, 1.8, nullptr);     // what the face does in that piece
///
/// Pieces of sound and the times of words rarely have the same borders: a word may begin in one
/// piece and end in the next one, and times may come before or behind their sound.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "dam/script/words.h"

namespace animeme::speech {

/// A part of an utterance.
struct UtterancePart {
  dam::Script script;                  ///< from 0 to the length of the part, without gaps
  std::vector<dam::ScriptWord> words;  ///< that begin in it; some may end behind it
  bool goes_on = false;                ///< its first phone is the rest of one that began before it
};

/// Seconds count from the begin of the utterance. Not thread safe.
class UtteranceTimes {
 public:
  /// Adds phones whose times count from `from`. They replace those that were known from the first
  /// of them on to the last; a phone that reaches into them is cut. `lasting`: the last phone that
  /// was known lasts until the first one of these if that is less than 0.3 s, for services that
  /// tell when a sound begins, and not when it ends.
  void add(const dam::Script& script, double from, bool lasting = false);
  /// Nothing is known of what comes later.
  double known() const { return known_; }
  /// Whether anything is known.
  bool empty() const { return phones_.empty() && known_ <= 0; }
  /// From `begin` to `end`, > `begin`. What is not known is silence, or, where all of the times
  /// told end before, what was `heard` there: a script whose time 0 is `begin`.
  UtterancePart between(double begin, double end, const dam::Script* heard) const;
  /// Forgets phones that end before `time`.
  void forget(double time);

 private:
  std::vector<dam::Phone> phones_;  // ascending, without silence
  double known_ = 0;
};

}  // namespace animeme::speech
