#include "tools/media/live/recorder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/media/detail/face_header.h"

#include "tools/media/live/presentation.h"

namespace animeme::media {

namespace {

constexpr std::size_t kCodeBytes = 4;

// Streams begin with the object start code, planes in their middle do not.
void add_object_start(std::vector<std::uint8_t>& bytes) {
  const bool plane = bytes.size() >= kCodeBytes && bytes[0] == 0 && bytes[1] == 0 &&
                     bytes[2] == 1 && bytes[3] == 0xBB;
  if (plane) bytes.insert(bytes.begin(), kObjectStart.begin(), kObjectStart.end());
}

}  // namespace

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
  const bool late = options_.duration > 0 && seconds >= *first_ + options_.duration;
  return late || bytes_ + unit.bytes.size() > options_.max_bytes;
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
    if (options_.keep) {
      if (last) face_.units.back().duration = unit.time - *last;
      face_.units.push_back({unit.bytes, unit.intra, unit.time, duration});
    }
  } else {
    sound_samples_ += duration;
    if (options_.keep) sound_.packets.push_back({unit.bytes, unit.time, duration});
  }
  last = unit.time;
  if (options_.keep) bytes_ += unit.bytes.size();
  return true;
}

std::optional<LiveUnit> Recorder::accept(LiveEvent event) {
  if (ended_) return std::nullopt;
  if (const auto* info = std::get_if<LiveInfo>(&event); info != nullptr && !take_info(*info)) {
    ended_ = true;
    event = LiveEnd{};
  }
  if (std::holds_alternative<LiveEnd>(event)) ended_ = true;
  std::optional<LiveUnit> unit = recovery_.accept(std::move(event));
  if (!unit || !info_) return std::nullopt;
  if (beyond(*unit)) {
    ended_ = true;
    (void)recovery_.accept(LiveEnd{});
    return std::nullopt;
  }
  if (!keep(*unit)) return std::nullopt;
  return unit;
}

double Recorder::face_seconds() const {
  return info_ ? seconds_of(*info_, LiveTrack::face, face_end_ - face_begin_) : 0;
}

double Recorder::sound_seconds() const {
  return info_ ? seconds_of(*info_, LiveTrack::audio, sound_samples_) : 0;
}

Recording Recorder::recording() const {
  Recording out{face_, sound_};
  if (!info_) return out;
  out.face.config = info_->face_config;
  out.face.timescale = info_->timescale;
  const double scale = info_->timescale;
  std::int64_t face_zero = face_.units.empty() ? 0 : face_.units.front().time;
  std::int64_t sound_zero = 0;
  if (!sound_.packets.empty()) {
    out.sound.format = *info_->audio;
    const double rate = out.sound.format.sample_rate;
    sound_zero = sound_.packets.front().time + out.sound.format.priming;
    const auto sound_tick = std::llround(double(sound_zero) / rate * scale);
    if (face_.units.empty() || sound_tick <= face_zero) {
      face_zero = sound_tick;
    } else {
      sound_zero = std::llround(double(face_zero) / scale * rate);
    }
  }
  for (fba::AccessUnit& unit : out.face.units) unit.time -= face_zero;
  for (AudioPacket& packet : out.sound.packets) packet.time -= sound_zero;
  if (!out.face.units.empty()) add_object_start(out.face.units.front().bytes);
  return out;
}

}  // namespace animeme::media
