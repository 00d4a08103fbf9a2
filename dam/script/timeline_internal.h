// A script cut into the occurrences of Eq. 2: pauses split, silence around the speech added, every
// phone with its neighbours.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dam/script/script.h"

namespace animeme::dam {

/// One phone at one place. Seconds; a duration is at least kShortestPhone.
struct Occurrence {
  std::string label;
  double start = 0;
  double duration = 0;
  std::string left;  ///< label of the neighbour, empty: the resting mouth
  std::string right;
  double hold = 0;  ///< seconds in the middle in which local time stands still, < duration

  double end() const { return start + duration; }
  /// Seconds that local time 0..1 takes.
  double paced() const { return duration - hold; }
  /// Local time u: 0 at the start, 1 at the end.
  double local(double time) const {
    const double from_start = time - start, half = paced() / 2;
    if (hold == 0 || from_start <= half) return from_start / paced();
    return from_start >= half + hold ? (from_start - hold) / paced() : 0.5;
  }
};

/// Shorter phones are treated as this long, so that local time stays finite.
inline constexpr double kShortestPhone = 0.005;

/// The occurrences of a script in time order. Gaps are silence. The speech has `pause_edge`
/// seconds of SIL before it and after it, also where the script has none. A pause longer than
/// twice that becomes two such pieces; between them the mouth rests and there is no phone.
/// A script without speech has no occurrences.
std::vector<Occurrence> make_timeline(const Script& script, double pause_edge);

/// Sounds that last longer than `longest` of their phone hold their middle for the rest of the
/// time, as singers do: the way in and the way out keep their pace. `longest_of` gives seconds by
/// label.
void hold_drawn_out(std::vector<Occurrence>& timeline,
                    const std::function<double(const std::string&)>& longest_of);

/// Stretches of speech: [start, end) of phones other than SIL, joined where they touch.
struct Stretch {
  double start = 0;
  double end = 0;
};
std::vector<Stretch> speech_stretches(const Script& script);

/// Seconds from `time` to the nearest stretch, 0 inside, infinity if there is none.
double distance_to_speech(const std::vector<Stretch>& stretches, double time);

}  // namespace animeme::dam
