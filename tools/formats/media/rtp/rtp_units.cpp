#include "tools/formats/media/rtp/rtp_units.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "codec/decode/plane_header.h"
#include "tools/formats/media/detail/sound/audio_headers.h"
#include "tools/formats/media/detail/tracks/face_header.h"

namespace animeme::media {
namespace {

constexpr fap::Rate kUnknownRate{30, 1};  // assumed until the stream has its rate

// a * b / c to the nearest, halves up; c > 0. Wide enough for times of centuries.
std::int64_t scale(std::int64_t a, std::int64_t b, std::int64_t c) {
  std::int64_t whole = a / c;
  std::int64_t rest = a % c;
  if (rest < 0) {
    rest += c;
    --whole;
  }
  return whole * b + (rest * b + c / 2) / c;
}

}  // namespace

std::int64_t from_timescale(std::int64_t time, std::uint32_t timescale) {
  return scale(time, kFaceClock, timescale);
}

std::int64_t to_timescale(std::int64_t ticks, std::uint32_t timescale,
                          std::optional<fap::Rate> rate) {
  const std::int64_t nearest = scale(ticks, timescale, kFaceClock);
  if (timescale <= kFaceClock || !rate) return nearest;
  const std::int64_t plane = scale(rate->den, timescale, rate->num);
  if (plane == 0) return nearest;
  const std::int64_t on_grid = scale(nearest, 1, plane) * plane;
  return std::abs(on_grid - nearest) <= timescale / kFaceClock + 1 ? on_grid : nearest;
}

RtpUnits FaceAssembler::add(const RtpPacket& packet, std::int64_t time) {
  RtpUnits out;
  std::vector<RtpUnit> planes;
  out.damaged = !joiner_.add(packet, time, planes);
  for (RtpUnit& plane : planes) {
    if (!add_plane(std::move(plane), out)) out.damaged = true;
  }
  return out;
}

bool FaceAssembler::add_plane(RtpUnit plane, RtpUnits& out) {
  const VisualHeaders headers = read_visual_headers(plane.bytes);
  if (headers.kind == VisualKind::other || headers.size > kMaxConfig) return false;
  if (headers.kind == VisualKind::face) {
    const auto end = plane.bytes.begin() + std::ptrdiff_t(headers.size);
    config_.assign(plane.bytes.begin(), end);
    plane.bytes.erase(plane.bytes.begin(), end);
    if (plane.bytes.empty()) return true;
  }
  if (config_.empty()) return true;
  const std::optional<fba::PlaneHeader> header = fba::read_plane_header(plane.bytes);
  if (!header) return false;
  if (header->temporal.rate) rate_ = header->temporal.rate->rate();
  const fap::Rate rate = rate_.value_or(kUnknownRate);
  const std::int64_t planes = 1 + std::int64_t(header->temporal.skip.value_or(0));
  const std::int64_t duration = scale(planes * rate.den, timescale_, rate.num);
  out.units.push_back({LiveTrack::face, std::move(plane.bytes), header->intra, plane.time,
                       std::max<std::int64_t>(1, duration)});
  return true;
}

AudioAssembler::AudioAssembler(const RtpAudioTrack& track)
    : format_(track.format), joiner_(track.fields, track.format.frame_samples) {}

RtpUnits AudioAssembler::add(const RtpPacket& packet, std::int64_t time) {
  RtpUnits out;
  std::vector<RtpUnit> frames;
  if (format_.codec == AudioCodec::aac) {
    out.damaged = !joiner_.add(packet, time, frames);
  } else if (!packet.payload.empty()) {
    frames.push_back({packet.payload, time});
  }
  for (RtpUnit& frame : frames) {
    const int duration =
        format_.codec == AudioCodec::aac ? format_.frame_samples : opus_samples(frame.bytes);
    if (duration == 0) {
      out.damaged = true;
      continue;
    }
    out.units.push_back({LiveTrack::audio, std::move(frame.bytes), false, frame.time, duration});
  }
  return out;
}

}  // namespace animeme::media
