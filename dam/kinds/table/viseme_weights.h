// Which poses a moment lies between: the geometry of viseme morphing, for training and synthesis.
#pragma once

#include <algorithm>
#include <cstddef>

namespace animeme::dam {

/// The stretch of a phone in which its pose is held.
struct Hold {
  double begin = 0, end = 0;  ///< seconds
};

/// `place` and `plateau` as in VisemeParameters.
inline Hold hold_of(double start, double duration, double place, double plateau) {
  return {start + duration * std::max(0.0, place - plateau / 2),
          start + duration * std::min(1.0, place + plateau / 2)};
}

/// The pose of phone `from` has weight 1 - share, that of `to` has share.
struct Between {
  std::size_t from = 0, to = 0;
  double share = 0;
};

/// `hold(j)` for 0 <= j < count in time order, count > 0. `near` is the last phone whose hold
/// begins at or before `time`; it only moves forward, so that frames in order cost little.
template <class HoldOf>
Between between_poses(std::size_t count, double time, const HoldOf& hold, std::size_t& near) {
  while (near + 1 < count && hold(near + 1).begin <= time) ++near;
  const Hold a = hold(near);
  if (near + 1 == count || time <= a.end) return {near, near, 0};
  const double gap = hold(near + 1).begin - a.end;
  return {near, near + 1, gap > 0 ? std::clamp((time - a.end) / gap, 0.0, 1.0) : 1.0};
}

}  // namespace animeme::dam
