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

/// Minimum opening of F, V and TH, mm: the teeth show.
inline constexpr double kTeethShow = 0.5;

/// Maximum by which the lower lip is below the edge of the upper teeth in F and V, mm.
inline constexpr double kLipAtTeeth = 2;

/// Maximum by which the tip of the tongue is behind that edge in TH, mm: the teeth's thickness.
inline constexpr double kTongueBehind = 2.5;

/// Maximum distance of closed lids, as a share of that at rest. Some makers leave a slit of a
/// sixth.
inline constexpr double kShutLids = 0.2;

/// The same for W, which lasts a tenth of a second.
inline constexpr double kRoundGlide = 0.03;

/// What is measured.
struct SpeakOptions {
  /// The phones are known, as in a file of `speak`: a head shows them by its own visemes, if it has
  /// them (head::PoseOptions::visemes). False: by FAPs alone, as a stream has.
  bool visemes = true;
};

/// Speaks "P AA B AA M AA, IY, UW, AA F AA V AA TH AA, IY W IY, OW" with the built-in model (style
/// 1, its articulation, 50 frames a second; lips opened wider by the gain of the rig) and measures
/// the mesh as it is drawn at the middle of the lips (points 2.2 and 2.3), their corners (2.4,
/// 2.5), the edge of the upper teeth, the tip of the tongue, and the lids (3.1 to 3.4) of a blink.
/// P B M within 0.1 mm of the lips at rest; UW, OW and W narrower than IY (kRoundVowel,
/// kRoundGlide), 0.5 mm further forward, and open; AA 70 % of the opening of a full jawOpen
/// (fap/arkit.h; of the head's own aa, if that is less and is what it speaks by); IY apart, at
/// most 1.2 times as far as AA; F, V and TH apart by kTeethShow; in F and V the lower lip at the
/// upper teeth (kLipAtTeeth), in TH the tongue (kTongueBehind; by FAPs alone speech has none),
/// closed lids at most kShutLids apart: these three where the head has the parts. Errors: not_found
/// (the head lacks one of the four points of the mouth or its ES), those of synthesise().
Result<std::vector<SpeakRow>> check_speech(const head::Head& head, const head::Rig& rig,
                                           const SpeakOptions& options = {});

}  // namespace animeme::studio
