#include "dam/speaking/rest_gate_internal.h"

#include <algorithm>

#include "dam/maths/raised_cosine.h"

namespace animeme::dam {
namespace {

constexpr double kShortestEndRamp = 0.08;  // seconds, also if the speech begins earlier

}  // namespace

RestGate::RestGate(const Script& script, double edge, bool rest_at_ends, double last_frame)
    : stretches_(speech_stretches(script)), edge_(edge), ends_(rest_at_ends), end_(last_frame) {
  if (stretches_.empty()) return;
  lead_in_ = std::clamp(stretches_.front().start, kShortestEndRamp, kEndRamp);
  lead_out_ = std::clamp(end_ - stretches_.back().end, kShortestEndRamp, kEndRamp);
}

double RestGate::operator()(double time) const {
  const double distance = distance_to_speech(stretches_, time);
  double gate = raised_step((edge_ - distance) / (edge_ / 3));
  if (ends_) gate *= raised_step(time / lead_in_) * raised_step((end_ - time) / lead_out_);
  return gate;
}

}  // namespace animeme::dam
