/// @file
/// A script as weights of visemes over time, for faces that have a modelled shape for each of them.
///
///     dam::VisemeCurves curves(script);
///     options.visemes = curves.at(seconds);          // head::PoseOptions
///
/// viseme_track.h instead makes FAP 1 of a stream: two visemes, by the motion of a clip.
#pragma once

#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/viseme.h"

namespace animeme::dam {

/// The sounds of a script, blended by time and dominance (M. M. Cohen, D. W. Massaro, "Modeling
/// coarticulation in synthetic visual speech", 1993): each begins a little before its time and
/// ends a little after, and where several are near each counts by its dominance. Vowels and what
/// rounds the lips or shows the tongue between the teeth dominate; sounds of the back of the tongue
/// take much of their neighbours. P, B, M, F, V, TH and DH are shown alone in their middle, for
/// at least 42 ms, so that a frame of 25 a second sees them. HH takes the viseme of the next sound.
class VisemeCurves {
 public:
  /// An empty script gives silence at any time.
  explicit VisemeCurves(const Script& script);

  /// Seconds on the clock of the script, in any order; cheap if they ascend. The sum is 1; silence
  /// is what is left. Continuous in time.
  fap::VisemeWeights at(double seconds) const;

 private:
  struct Sound {
    double start, end;     // seconds
    double before, after;  // in which it comes and goes
    int viseme;
    double dominance;
  };

  void add(double start, double end, int viseme);
  void limit_contacts();
  template <class Take>
  void for_present(const std::vector<Sound>& sounds, double seconds, double comes,
                   const Take& take) const;

  std::vector<Sound> sounds_;    // by start; also those that touch
  std::vector<Sound> contacts_;  // by start; shown alone in their middle
  double longest_ = 0;           // of a sound, with what it takes after
};

/// One for each frame of `clip`, whose frame number 0 is at `start` seconds. Empty if the script
/// has no phones.
std::vector<fap::VisemeWeights> viseme_weights(const Script& script, const fap::Sequence& clip,
                                               double start = 0);

}  // namespace animeme::dam
