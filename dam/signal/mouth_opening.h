/// @file
/// A rule for the mouth opening of vowels: AA wide, IY narrow, teeth together in S.
///
/// The more open a vowel is, the lower is the jaw (B. Lindblom and J. Sundberg, "Acoustical
/// consequences of lip, tongue, jaw, and larynx movement", JASA 50, 1971, 1166-1179: openness is a
/// position of the jaw), and the lips follow; sibilants need teeth that are close together. The
/// built-in model's speaker spreads his lips so much that his IY is nearly as open as his AA. On
/// another face both are then the same mouth. So synthesis narrows close sounds and widens open
/// ones. This is a rule, not learned, and off in training and evaluation. The figures are our
/// choice: AA becomes as wide as the widest twentieth of his, IY less than half of it. Effect and
/// cost: dam/measured.md, "Articulation rules".
#pragma once

#include <cstddef>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/closure.h"
#include "dam/signal/signal.h"

namespace animeme::dam {

/// Targets of the mouth opening. Gaps are between the inner lips, -(FAP 4 + FAP 5), in FAP units.
struct OpeningOptions {
  double wider = 0.4;  ///< relative increase of an open vowel (a) over what is learned
  double open = 1000;  ///< upper limit of the gap of open vowels ...
  double close = 300;  ///< ... and of close ones (i); by height in between
  double teeth = 270;  ///< upper limit for S, Z, SH, CH and the like
  double turn = 0.12;  ///< transition between the openings of two sounds, seconds
  double held = 0.15;  ///< seconds over which sounds without a target keep a neighbour's
};

/// Seconds from a moment to the farthest sound that can influence its target.
inline constexpr double kOpeningReach = 0.21;

/// The target opening of a script over time.
class MouthOpening {
 public:
  /// A target: first multiplied by `wider`, then limited.
  struct Target {
    double wider = 1;   ///< at least 1
    double narrow = 0;  ///< 1 / the limit of the gap; 0: no limit
    bool any() const { return wider != 1 || narrow != 0; }  ///< there is a target
  };

  /// Considers all phones of a script, by their features (dam/script/features.h): vowels and glides
  /// by height, sibilants. Labials have no target, other consonants and the edges of pauses take
  /// those of their neighbours.
  explicit MouthOpening(const Script& script, const OpeningOptions& options = {});
  /// The target at a time, with smooth transitions between sounds. Times may come in any order.
  Target operator()(double time) const;

 private:
  struct Turn {
    double centre;  // seconds
    Target after;
  };
  void then(double start, double end, const Target& wish);

  std::vector<Turn> turns_;  // in order
  OpeningOptions options_;
  double end_ = 0;  // of the last sound with a target, during construction
};

/// Opens jaw (FAP 3) and lips (4, 5, 8 to 11; 51, 52, 55 to 58 by `follow`) to the targets:
/// `amount` 1 as given, 0 not at all, beyond 1 open vowels are wider still. Lips that are pressed
/// together or closed stay as they are. `style` is the scale that has been applied to the signal;
/// it also scales the limits. Returns the number of frames that changed; 0 without FAP 4 and 5.
std::size_t open_mouth(const MouthOpening& opening, double amount, double style, Signal& signal,
                       const ClosureOptions& follow = {});

}  // namespace animeme::dam
