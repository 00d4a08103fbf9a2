#include "tools/formats/media/live/recorder.h"

#include <algorithm>
#include <utility>

#include "tools/formats/media/live/presentation.h"

namespace animeme::media {

bool Recorder::take_info(const LiveInfo& info) {
  if (!info_) {
    info_ = info;
    return true;
  }
  // A configuration that was not known before the first plane is no other presentation.
  const bool same_sound = info_->audio == info.audio || !last_[std::size_t(LiveTrack::audio)];
  const bool same_face = info_->timescale == info.timescale || !last_[std::size_t(LiveTrack::face)];
  if (!same_sound || !same_face) return false;
  info_ = info;
  return true;
}

bool Recorder::beyond(const LiveUnit& unit) {
  const double seconds = seconds_of(*info_, unit.track, unit.time);
  if (!first_) first_ = seconds;
  return options_.duration > 0 && seconds >= *first_ + options_.duration;
}

bool Recorder::keep(const LiveUnit& unit) {
  std::optional<std::int64_t>& last = last_[std::size_t(unit.track)];
  if (unit.bytes.empty() || (last && unit.time <= *last)) return false;
  const std::int64_t duration = std::max<std::int64_t>(1, unit.duration);
  if (unit.track == LiveTrack::face) {
    const RecoveryStats& stats = recovery_.stats();
    const std::int64_t left_out = stats.dropped + stats.lost;
    after_gap_ = last && left_out > left_out_;
    left_out_ = left_out;
    if (!last) face_begin_ = unit.time;
    face_end_ = unit.time + duration;
  } else {
    sound_samples_ += duration;
  }
  last = unit.time;
  if (options_.keep) {
    LiveUnit own = unit;
    own.duration = duration;
    times_.push(*info_, std::move(own));
  }
  return true;
}

std::optional<LiveUnit> Recorder::accept(LiveEvent event) {
  if (ended_) return std::nullopt;
  if (const auto* info = std::get_if<LiveInfo>(&event); info != nullptr && !take_info(*info)) {
    event = LiveEnd{};
  }
  if (std::holds_alternative<LiveEnd>(event)) end();
  std::optional<LiveUnit> unit = recovery_.accept(std::move(event));
  if (!unit || !info_) return std::nullopt;
  if (beyond(*unit)) {
    end();
    (void)recovery_.accept(LiveEnd{});
    return std::nullopt;
  }
  if (!keep(*unit)) return std::nullopt;
  return unit;
}

void Recorder::end() {
  ended_ = true;
  if (info_) times_.finish(*info_);
}

double Recorder::face_seconds() const {
  return info_ ? seconds_of(*info_, LiveTrack::face, face_end_ - face_begin_) : 0;
}

double Recorder::sound_seconds() const {
  return info_ ? seconds_of(*info_, LiveTrack::audio, sound_samples_) : 0;
}

}  // namespace animeme::media
