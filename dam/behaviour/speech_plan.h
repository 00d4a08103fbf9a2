/// @file
/// What face and head may do at: phrases and accents of a script, from its sounds, its words'
/// punctuation and, where there is a recording, its pitch and level.
#pragma once

#include <vector>

#include "dam/behaviour/prosody.h"
#include "dam/script/script.h"

namespace animeme::dam {

/// Speech between two pauses, seconds.
struct SpeechPhrase {
  double start = 0;        ///< first sound
  double end = 0;          ///< last sound
  bool begins = false;     ///< with it an utterance begins: a pause of 0.6 s or nothing before it
  bool ends = false;       ///< with it an utterance ends: such a pause, or . ? ! at its last word
  bool question = false;   ///< its last word ends in "?" (or that of another script)
  bool exclaimed = false;  ///< its last word ends in "!" (likewise)
};

/// A stressed vowel.
struct SpeechAccent {
  double start = 0;     ///< of the vowel, seconds
  double end = 0;       ///< of the vowel
  double weight = 0;    ///< prominence, above 0, at most 1
  bool rise = false;    ///< the pitch rises to it; without a recording: a weight of 0.7 or more
  bool strong = false;  ///< the most prominent of its phrase
};

/// A script as a behaviour sees it.
struct SpeechPlan {
  std::vector<SpeechPhrase> phrases;  ///< in time order
  std::vector<SpeechAccent> accents;  ///< in time order, at least 0.3 s apart
  double step = 0.01;                 ///< seconds between the values below
  /// Semitones above the median of the voice, interpolated where there is no voice; may be empty.
  std::vector<float> pitch;
  std::vector<float> level;  ///< 0 silent, 0.5 the median of what is heard, 1 loud; as long
};

/// Phrases and accents of a script.
///
/// - Phrases end at pauses of 0.2 s, or at any silence behind a word with punctuation.
/// - Accents: vowels that last longer than the median of the script, each measured by what is usual
///   for it (AX is never stressed, diphthongs are longer, the last vowel before a pause is drawn
///   out). With `prosody`, pitch and level of a vowel above its surroundings count as well.
///
/// `prosody`: of the sound of the script, from its beginning; nullptr or empty: not known.
SpeechPlan plan_speech(const Script& script, const Prosody* prosody = nullptr);

}  // namespace animeme::dam
