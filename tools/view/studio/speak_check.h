/// @file
/// Checks how well a head can show speech, measured on its deformed mesh.
#pragma once

#include <string>
#include <vector>

#include "fap/head/rig.h"

namespace animeme::studio {

/// A row of the table.
struct SpeakRow {
  std::string sound;    ///< "P", "UW against IY", ...
  std::string what;     ///< what was measured, with its unit
  double value = 0;     ///< finite
  double limit = 0;     ///< limit for the value
  bool at_most = true;  ///< requires value <= limit; else value >= limit
  bool ok() const {
    return at_most ? value <= limit : value >= limit;
  }  ///< whether the requirement is met
};

/// Reference distance of the eyes (ES of its FAPU) for scaling lengths, mm.
inline constexpr double kEyesApart = 63;

/// Minimum opening of a spoken AA, as a share of a full jawOpen.
inline constexpr double kWideOpen = 0.7;

/// Maximum opening of a spoken IY, as a share of a spoken AA: the lips are as recorded,
/// and between lips that close the recorded speaker opens them less in AA than in IY.
inline constexpr double kCloseVowel = 1.2;

/// Minimum by which the mouth is narrower in UW than in IY, as a share of its width. The recorded
/// speaker has 0.1.
inline constexpr double kRoundVowel = 0.05;

/// The Head::mouth_gain with which the AA of check_speech() reaches this opening, from 1 to
/// fap::kMostMouthGain (the latter if it never does). Deterministic. Errors: those of
/// check_speech().
Result<double> speaking_gain(const head::Head& head);

/// Speaks "P AA B AA M AA IY UW" with the built-in model (style 1, its articulation, 50 frames a
/// second; lips opened wider by the gain of the rig) and measures at the middle of the lips
/// (points 2.2 and 2.3), their corners (2.4, 2.5): P B M within 0.1 mm of the lips at rest, UW 5 %
/// narrower than IY and further forward, AA 70 % of the opening of a full jawOpen (fap/arkit.h), IY
/// and UW apart, IY at most 1.2 times as far as AA. Errors: not_found (the head lacks one of the
/// four points or its ES), those of synthesise().
Result<std::vector<SpeakRow>> check_speech(const head::Head& head, const head::Rig& rig);

}  // namespace animeme::studio
