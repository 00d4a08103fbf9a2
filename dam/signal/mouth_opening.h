/// @file
/// A rule for the jaw: low in AA, high in IY, teeth together in S.
///
/// The more open a vowel is, the lower is the jaw (B. Lindblom and J. Sundberg, "Acoustical
/// consequences of lip, tongue, jaw, and larynx movement", JASA 50, 1971, 1166-1179), and sibilants
/// need teeth that are close together. A model averages over its sentences, so its jaw moves less
/// from sound to sound than a jaw does. Synthesis lowers the jaw of open vowels and raises that of
/// close ones and of sibilants. The lips are not touched: recorded people, ten of them, open them
/// in IY and S about as wide as in their speech on average (0.65 to 0.8 and 0.3 to 0.5 deviations
/// wider), while their jaw is higher in S than on average (by 0.2 to 0.6). This is a rule, not
/// learned, and off in training and evaluation. Effect and cost: dam/measured.md, "Rules".
#pragma once

#include <cstddef>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"

namespace animeme::dam {

/// Targets of the jaw, FAP 3, in FAP units.
struct OpeningOptions {
  double wider = 0.2;  ///< relative increase of an open vowel (a) over what is learned
  double open = 400;   ///< upper limit of open vowels ...
  double close = 190;  ///< ... and of close ones (i); by height in between
  double teeth = 150;  ///< upper limit for S, Z, SH, CH and the like
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
    double wider = 1;                                       ///< at least 1
    double narrow = 0;                                      ///< 1 / the limit of FAP 3; 0: no limit
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

/// Moves the jaw (FAP 3) to the targets: `amount` 1 as given, 0 not at all, beyond 1 open vowels
/// are wider still. A jaw that is at rest or above it stays as it is. `style` is the scale that has
/// been applied to the signal; it also scales the limits. Returns the number of frames that
/// changed.
std::size_t open_mouth(const MouthOpening& opening, double amount, double style, Signal& signal);

}  // namespace animeme::dam
