/// @file
/// A rule for the tongue: which way it goes in each sound, by the sound's articulation
/// (dam/script/features.h), blended over time by dominance (M. M. Cohen, D. W. Massaro, "Modeling
/// coarticulation in synthetic visual speech", 1993).
///
/// The tip is between the teeth in TH and DH, at the ridge behind the upper teeth in T, D, N and L,
/// just below it in S and Z, behind it in SH, CH and R; the back is raised in K, G and NG; R and ER
/// curl the sides; the tongue lies low in AA and is raised in front in IY. Labials and HH leave it
/// to their neighbours. Nothing passes the teeth while the lips are shut. This is a rule for models
/// that do not have the tongue, not learned, and off in training and evaluation. The values are
/// those of fap/expand.h, chosen by eye on the heads of fap/head.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"

namespace animeme::dam {

/// FAP 44 to 47 at one instant, in their units. FAP 43, to the side, is not used in speech.
struct TonguePose {
  double tip_up = 0;   ///< FAP 44
  double tip_out = 0;  ///< FAP 45
  double back_up = 0;  ///< FAP 46
  double rolled = 0;   ///< FAP 47
};

/// Seconds from a moment to the farthest sound that is felt in it, beside the sound's own duration.
inline constexpr double kTongueReach = 0.1;

/// The tongue of a script over time.
class TongueCurves {
 public:
  /// An empty script leaves it at rest.
  explicit TongueCurves(const Script& script);
  /// The tongue at a time in seconds; continuous. Cheap if times ascend.
  TonguePose at(double seconds) const;

 private:
  struct Sound {
    double start, end;  // seconds
    double weight;
    TonguePose pose;
  };
  std::vector<Sound> sounds_;  // by start
  double longest_ = 0;
};

/// Whether a signal has channels for the tongue of its own (FAP 43 to 47, ARKit's tongueOut).
bool has_tongue(const Signal& signal);

/// Adds channels for FAP 44 to 47, rounded to kTongueStep units, to a signal of FAPs that has jaw
/// or lips and no tongue. Returns false, and changes nothing, for any other signal.
bool add_tongue(Signal& signal, const Script& script);

/// FAP units: steps of FAP 44 to 46, 1 mm of height on a head of usual size. Finer ones are not
/// seen behind lips, and would cost a stream half as much again.
inline constexpr double kTongueStep = 60;

}  // namespace animeme::dam
