// When the mouth rests: in long pauses and at the ends of a clip.
#pragma once

#include <vector>

#include "dam/script/script.h"
#include "dam/script/timeline_internal.h"

namespace animeme::dam {

/// Seconds in which a clip leaves and reaches rest.
inline constexpr double kEndRamp = 0.1;

/// How much of the deviation from rest is shown: fades from two thirds of `edge` seconds from
/// speech to nothing at `edge`, and, if wanted, over the first and the last frames of the clip.
class RestGate {
 public:
  /// `last_frame` in seconds; infinity while the end is not known.
  RestGate(const Script& script, double edge, bool rest_at_ends, double last_frame);
  /// 0..1 at a time in seconds.
  double operator()(double time) const;

 private:
  std::vector<Stretch> stretches_;
  double edge_;
  bool ends_;
  double end_;
  double lead_in_ = kEndRamp, lead_out_ = kEndRamp;
};

}  // namespace animeme::dam
