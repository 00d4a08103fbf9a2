#include "tools/formats/media/live/live_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/decode/fill.h"

namespace animeme::media {

namespace {

constexpr double kEaseSeconds = 0.4;
constexpr std::int64_t kMostGapFrames = 100'000;

/// `share` of the way from neutral.
fap::Frame towards_neutral(fap::Frame frame, double share) {
  for (std::int32_t& value : frame.value) value = std::int32_t(std::lround(value * share));
  frame.expression.intensity1 = int(std::lround(frame.expression.intensity1 * share));
  frame.expression.intensity2 = int(std::lround(frame.expression.intensity2 * share));
  if (share <= 0) frame.viseme = {};
  return frame;
}

}  // namespace

/// A decoder knows that a plane is complete when the next one begins, which would be a plane too
/// late: a copy of it is told that nothing follows.
std::optional<fba::Plane> LiveFrames::decode(const LiveUnit& unit) {
  std::optional<fba::Plane> plane;
  const auto drain = [&](fba::Decoder& decoder) {
    std::int64_t planes = 0;
    for (;;) {
      Result<fba::Event> event = decoder.next();
      if (event && event->kind == fba::Event::Kind::plane) {
        plane = std::move(event->plane);
        ++planes;
      }
      if (event) continue;
      // After any other error the decoder goes on with the next intra plane.
      const Code code = event.error().code;
      if (code == Code::need_data || code == Code::end_of_stream || code == Code::truncated) {
        return planes;
      }
    }
  };
  decoder_.push(unit.bytes);
  ++pushed_;
  delivered_ += drain(decoder_);
  if (delivered_ == pushed_) return plane;
  plane.reset();
  fba::Decoder ahead = decoder_;
  ahead.finish();
  drain(ahead);
  return plane;
}

void LiveFrames::add_gap(std::int64_t end, bool lost, std::vector<fap::Frame>& frames) const {
  if (!last_ || gap_ == GapRule::skip) return;
  end = std::min(end, last_->number + 1 + kMostGapFrames);
  for (std::int64_t number = last_->number + 1; number < end; ++number) {
    fap::Frame frame = *last_;
    frame.viseme.def = frame.expression.def = frame.expression.init_face = false;
    if (lost && gap_ == GapRule::neutral) {
      const double gone = rate_.seconds(double(number - last_->number)) / kEaseSeconds;
      frame = towards_neutral(frame, std::max(0.0, 1 - gone));
    }
    frame.number = number;
    frames.push_back(frame);
  }
}

fap::Frame LiveFrames::shown(const fba::Plane& plane, const fap::Frame& frame) {
  const fap::GroupRules rules =
      plane.face_settings ? fba::group_rules(*plane.face_settings) : fap::GroupRules{};
  const fap::Frame& received = receiver_->receive(frame, rules);
  return fap::with_mask(received, receiver_->mask());
}

std::vector<fap::Frame> LiveFrames::push(const LiveUnit& unit, std::uint32_t timescale,
                                         bool after_gap) {
  const std::optional<fba::Plane> plane = decode(unit);
  std::vector<fap::Frame> frames;
  damaged_ = damaged_ || !plane;
  if (!plane || !fba::has_face(plane->object_mask)) return frames;
  rate_ = plane->rate;
  if (!first_time_) first_time_ = unit.time;
  const double seconds = double(unit.time - *first_time_) / timescale;
  fap::Frame frame = plane->face;
  frame.number = std::llround(seconds * rate_.frames_per_second());
  if (last_) frame.number = std::max(frame.number, last_->number + 1);
  if (after_gap || damaged_ || receiver_) add_gap(frame.number, after_gap || damaged_, frames);
  damaged_ = false;
  if (receiver_) frame = shown(*plane, frame);
  frames.push_back(frame);
  last_ = frame;
  return frames;
}

}  // namespace animeme::media
