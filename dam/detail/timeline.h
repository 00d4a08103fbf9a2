// A script cut into the occurrences of Eq. 2: pauses split, silence around the speech added, every
// phone with its neighbours.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dam/script.h"

namespace animeme::dam {

/// One phone at one place. Seconds; a duration is at least kShortestPhone.
struct Occurrence {
  std::string label;
  double start = 0;
  double duration = 0;
  std::string left;  ///< label of the neighbour, empty: the resting mouth
  std::string right;

  double end() const { return start + duration; }
};

/// Shorter phones are treated as this long, so that local time stays finite.
inline constexpr double kShortestPhone = 0.005;

/// The occurrences of a script in time order. Gaps are silence. The speech has `pause_edge`
/// seconds of SIL before it and after it, also where the script has none. A pause longer than
/// twice that becomes two such pieces; between them the mouth rests and there is no phone.
/// A script without speech has no occurrences.
std::vector<Occurrence> make_timeline(const Script& script, double pause_edge);

/// Stretches of speech: [start, end) of phones other than SIL, joined where they touch.
struct Stretch {
  double start = 0;
  double end = 0;
};
std::vector<Stretch> speech_stretches(const Script& script);

/// Seconds from `time` to the nearest stretch, 0 inside, infinity if there is none.
double distance_to_speech(const std::vector<Stretch>& stretches, double time);

}  // namespace animeme::dam
