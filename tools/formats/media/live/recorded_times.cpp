#include "tools/formats/media/live/recorded_times.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/formats/media/detail/tracks/face_header.h"
#include "tools/formats/media/live/presentation.h"

namespace animeme::media {

namespace {

constexpr double kLongestHeld = 1;            // seconds
constexpr std::size_t kMostUnitsHeld = 1000;  // units, whatever their times say
constexpr std::size_t kCodeBytes = 4;

// Streams begin with the object start code, planes in their middle do not.
void add_object_start(std::vector<std::uint8_t>& bytes) {
  const bool plane = bytes.size() >= kCodeBytes && bytes[0] == 0 && bytes[1] == 0 &&
                     bytes[2] == 1 && bytes[3] == 0xBB;
  if (plane) bytes.insert(bytes.begin(), kObjectStart.begin(), kObjectStart.end());
}

}  // namespace

void RecordedTimes::push(const LiveInfo& info, LiveUnit unit) {
  if (settled_) return place(info, std::move(unit));
  std::optional<LiveUnit>& first = first_[std::size_t(unit.track)];
  if (!first) first = unit;
  const double lasted = seconds_of(info, unit.track, unit.time - first->time);
  held_.push_back(std::move(unit));
  const bool face_is_there = first_[0] || info.face_config.empty();
  const bool sound_is_there = first_[1] || !info.audio;
  if ((face_is_there && sound_is_there) || lasted >= kLongestHeld ||
      held_.size() > kMostUnitsHeld) {
    settle(info);
  }
}

void RecordedTimes::settle(const LiveInfo& info) {
  settled_ = true;
  const double scale = info.timescale;
  if (first_[0]) zero_[0] = first_[0]->time;
  if (info.audio) {
    priming_ = info.audio->priming;
    const double rate = info.audio->sample_rate;
    const std::int64_t heard = first_[1] ? first_[1]->time + priming_ : 0;
    const auto heard_at = std::llround(double(heard) / rate * scale);
    if (first_[1] && (!first_[0] || heard_at <= zero_[0])) {
      zero_[0] = heard_at;
      zero_[1] = heard;
    } else {
      zero_[1] = std::llround(double(zero_[0]) / scale * rate);
    }
  }
  for (LiveUnit& unit : std::exchange(held_, {})) place(info, std::move(unit));
}

void RecordedTimes::place(const LiveInfo& info, LiveUnit unit) {
  const bool face = unit.track == LiveTrack::face;
  unit.time -= zero_[std::size_t(unit.track)];
  if (unit.time < (face ? 0 : -priming_)) return;
  if (!face) {
    const bool late = plane_ && seconds_of(info, LiveTrack::audio, unit.time) >
                                    seconds_of(info, LiveTrack::face, plane_->time) + kLongestHeld;
    if (late) give_plane();
    return ready_.push_back(std::move(unit));
  }
  if (!begun_) add_object_start(unit.bytes);
  begun_ = true;
  if (plane_) plane_->duration = unit.time - plane_->time;
  give_plane();
  plane_ = std::move(unit);
}

void RecordedTimes::give_plane() {
  if (!plane_) return;
  ready_.push_back(std::move(*plane_));
  plane_.reset();
  given_ = true;
}

void RecordedTimes::finish(const LiveInfo& info) {
  if (!settled_) settle(info);
  give_plane();
}

std::vector<LiveUnit> RecordedTimes::take() {
  // A file wants to know where both tracks begin before it begins itself.
  if (plane_ && !given_) return {};
  return std::exchange(ready_, {});
}

}  // namespace animeme::media
