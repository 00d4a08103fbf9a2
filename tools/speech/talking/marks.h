/// @file
/// Scripts with SSML marks and with what an aligner or a recogniser doubts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "tools/speech/voice/align.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {

/// Phones of sound alone below are doubtful: more likely wrong than right.
inline constexpr double kDoubtfulPhone = 0.5;

/// A part of a script to be checked by ear.
struct Doubt {
  double start = 0;       ///< seconds
  double end = 0;         ///< seconds, behind `start`
  std::string text;       ///< its word, or its phones
  double confidence = 0;  ///< 0..1
};

/// Of a script that was aligned or recognised.
struct Doubts {
  std::vector<double> confidences;  ///< of each phone, 0..1; empty: not known
  std::vector<Doubt> doubtful;      ///< ascending, without overlaps
};

/// The words of an alignment below voice::kDoubtful, as its warnings name them; those that are not
/// said have no place.
Doubts doubts_of(const std::vector<double>& confidences,
                 const std::vector<voice::AlignedWord>& words);

/// Stretches of recognised phones below kDoubtfulPhone. `confidences`: of each phone.
Doubts doubts_of(const dam::Script& script, const std::vector<double>& confidences);

/// dam::write_script() with marks and doubts. A TextGrid has a tier of points "marks", and the
/// tiers "confidence" (of each phone, "0.93") and "doubtful" ("word 0.03"), which readers of
/// scripts pass over. WebVTT has a comment for each mark ("NOTE mark 00:00:01.234 name"). Other
/// formats support neither. Without marks and confidences the bytes are those of
/// dam::write_script().
std::string write_marked_script(const dam::Script& script,
                                const std::vector<voice::SpeechMark>& marks,
                                std::string_view ending, const Doubts& doubts = {});

}  // namespace animeme::speech
