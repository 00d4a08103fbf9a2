/// @file
/// Mouths that open as the vowel asks for: AA wide, IY narrow, teeth together in S.
///
/// The more open a vowel is, the lower is the jaw (B. Lindblom and J. Sundberg, "Acoustical
/// consequences of lip, tongue, jaw, and larynx movement", JASA 50, 1971, 1166-1179: openness is a
/// position of the jaw), and lips go with it; sibilants need teeth that are close together. The
/// built-in model's speaker spreads his lips so much that his IY is nearly as open as his AA. On a
/// face that is not his, both are then the same mouth. So speaking narrows what is close and widens
/// what is open. It is not learned but a rule, off in training and evaluation. The figures are
/// ours: AA becomes as wide as the widest twentieth of his, IY less than half of it. What that
/// changes and costs: dam/measured.md, "Rules on top".
#pragma once

#include <cstddef>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/closure.h"
#include "dam/signal/signal.h"

namespace animeme::dam {

/// How far mouths open. Gaps are those between the inner lips, -(FAP 4 + FAP 5), in FAP units.
struct OpeningOptions {
  double wider = 0.4;  ///< added to what is learned of an open vowel (a), as a share of it
  double open = 1000;  ///< gap that no open vowel reaches ...
  double close = 300;  ///< ... and no close one (i); by height in between
  double teeth = 270;  ///< the same of S, Z, SH, CH and the like
  double turn = 0.12;  ///< seconds from one sound's opening to the next one's
  double held = 0.15;  ///< seconds over which sounds without a wish keep a neighbour's
};

/// Seconds from a moment to the farthest sound that may tell what is wanted then.
inline constexpr double kOpeningReach = 0.21;

/// What the sounds of a script want of the opening, at a time.
class MouthOpening {
 public:
  /// What is wanted: first `wider` times as open as learned, then limited.
  struct Wish {
    double wider = 1;   ///< 1 and more
    double narrow = 0;  ///< 1 / the gap that is not reached; 0: no limit
    bool any() const { return wider != 1 || narrow != 0; }  ///< anything is wanted
  };

  /// Of all phones of a script, by their features (dam/script/features.h): vowels and glides by
  /// height, sibilants. Those of the lips want nothing, other consonants and the edges of pauses
  /// leave it to their neighbours.
  explicit MouthOpening(const Script& script, const OpeningOptions& options = {});
  /// Times may come in any order. Between those of two sounds, without a corner.
  Wish operator()(double time) const;

 private:
  struct Turn {
    double centre;  // seconds
    Wish after;
  };
  void then(double start, double end, const Wish& wish);

  std::vector<Turn> turns_;  // in order
  OpeningOptions options_;
  double end_ = 0;  // of the last sound with a wish, while they are gathered
};

/// Opens jaw (FAP 3) and lips (4, 5, 8 to 11; 51, 52, 55 to 58 as `follow` says) as far as
/// `opening` wants: `amount` 1 as it says, 0 not at all, beyond 1 open vowels are wider still.
/// Lips that are pressed together or shut stay as they are. `style` is what the signal has been
/// made larger by: limits are, too. Returns the number of frames that changed; 0 without FAP 4
/// and 5.
std::size_t open_as_wanted(const MouthOpening& opening, double amount, double style, Signal& signal,
                           const ClosureOptions& follow = {});

}  // namespace animeme::dam
