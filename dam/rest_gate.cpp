#include "dam/detail/rest_gate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace animeme::dam {
namespace {

constexpr double kShortestEndRamp = 0.08;  // seconds, also if the speech begins earlier

/// 0 at x <= 0, 1 at x >= 1, a raised cosine between.
double smooth_step(double x) {
  if (x <= 0) return 0;
  return x >= 1 ? 1.0 : 0.5 * (1 - std::cos(std::numbers::pi * x));
}

}  // namespace

RestGate::RestGate(const Script& script, double edge, bool rest_at_ends, double last_frame)
    : stretches_(speech_stretches(script)), edge_(edge), ends_(rest_at_ends), end_(last_frame) {
  if (stretches_.empty()) return;
  lead_in_ = std::clamp(stretches_.front().start, kShortestEndRamp, kEndRamp);
  lead_out_ = std::clamp(end_ - stretches_.back().end, kShortestEndRamp, kEndRamp);
}

double RestGate::operator()(double time) const {
  const double distance = distance_to_speech(stretches_, time);
  double gate = smooth_step((edge_ - distance) / (edge_ / 3));
  if (ends_) gate *= smooth_step(time / lead_in_) * smooth_step((end_ - time) / lead_out_);
  return gate;
}

}  // namespace animeme::dam
