#include "tools/formats/media/rtp/rtp_payload.h"

#include <algorithm>

#include "codec/syntax/bits.h"
#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::media {
namespace {

constexpr std::size_t kMaxPlane = 1 << 20;
constexpr std::size_t kMaxFrame = 1 << 16;
constexpr std::size_t kAacHeader = 2;  // 13 bits of size, 3 of index

ByteVector aac_headers(std::span<const ByteVector> frames) {
  ByteVector out;
  put(out, frames.size() * kAacHeader * 8, 2);
  for (const ByteVector& frame : frames) put(out, frame.size() << 3, 2);
  return out;
}

bool begins_with_start_code(ByteSpan bytes) {
  return bytes.size() >= 4 && bytes[0] == 0 && bytes[1] == 0 && bytes[2] == 1;
}

void cut_bundle(const RtpPacket& packet, std::int64_t time, std::vector<RtpUnit>& units) {
  ByteSpan rest = packet.payload;
  std::int64_t plane_time = time;
  const auto cut = [&](std::size_t size) {
    const ByteSpan plane = rest.first(size);
    units.push_back({{plane.begin(), plane.end()}, plane_time});
    rest = rest.subspan(size);
  };
  for (const BundledPlane& next : packet.bundle) {
    cut(next.previous_size);
    plane_time = time + next.delay;
  }
  cut(rest.size());
}

}  // namespace

std::vector<RtpPayload> split_plane(ByteSpan plane, std::size_t room) {
  std::vector<RtpPayload> out;
  for (std::size_t at = 0; at < plane.size(); at += room) {
    const ByteSpan piece = plane.subspan(at, std::min(room, plane.size() - at));
    out.push_back({{piece.begin(), piece.end()}, at + room >= plane.size()});
  }
  return out;
}

std::size_t aac_packet_size(std::size_t frames, std::size_t bytes) {
  return 2 + frames * kAacHeader + bytes;
}

std::vector<RtpPayload> pack_aac(std::span<const ByteVector> frames, std::size_t room) {
  const ByteVector headers = aac_headers(frames);
  std::vector<RtpPayload> out;
  if (frames.size() != 1) {
    out.push_back({headers, true});
    for (const ByteVector& frame : frames) append(out.back().bytes, frame);
    return out;
  }
  for (RtpPayload& piece : split_plane(frames.front(), room - headers.size())) {
    out.push_back({headers, piece.marker});
    append(out.back().bytes, piece.bytes);
  }
  return out;
}

void PlaneJoiner::gap() {
  open_ = false;
  skipping_ = false;
  unit_ = {};
}

bool PlaneJoiner::add(const RtpPacket& packet, std::int64_t time, std::vector<RtpUnit>& units) {
  if (packet.payload.empty()) return true;
  if (skipping_) {
    skipping_ = unit_.time == time && !packet.marker;
    if (unit_.time == time) return true;
  }
  if (open_ && time != unit_.time) {  // a sender that does not mark
    units.push_back(std::move(unit_));
    open_ = false;
  }
  if (!open_) {
    unit_ = {{}, time};
    if (!begins_with_start_code(packet.payload)) {
      skipping_ = !packet.marker;
      return false;
    }
  }
  if (!packet.bundle.empty()) {
    open_ = false;
    cut_bundle(packet, time, units);
    return true;
  }
  append(unit_.bytes, packet.payload);
  open_ = !packet.marker;
  if (unit_.bytes.size() > kMaxPlane) {
    skipping_ = open_;
    open_ = false;
    unit_.bytes.clear();
    return false;
  }
  if (!open_) units.push_back(std::move(unit_));
  return true;
}

bool AacJoiner::add(const RtpPacket& packet, std::int64_t time, std::vector<RtpUnit>& units) {
  fba::BitReader head(packet.payload);
  const std::size_t header_bits = head.bits(16);
  const std::size_t data_begin = 2 + (header_bits + 7) / 8;
  if (packet.payload.size() <= data_begin) {
    gap();
    return false;
  }
  ByteSpan data = ByteSpan(packet.payload).subspan(data_begin);
  bool good = true;
  for (int frame = 0; head.position() + std::size_t(fields_.size_bits) <= 16 + header_bits;
       ++frame) {
    const std::size_t size = head.bits(fields_.size_bits);
    head.bits(frame == 0 ? fields_.index_bits : fields_.index_delta_bits);
    const std::int64_t frame_time = time + std::int64_t(frame) * samples_;
    if (size == 0 || size > kMaxFrame || (frame > 0 && size > data.size())) return false;
    const bool piece = size > data.size() || (!piece_.bytes.empty() && piece_.time == time);
    const ByteSpan bytes = data.first(std::min(size, data.size()));
    data = data.subspan(bytes.size());
    if (!piece) {
      good = good && piece_.bytes.empty();
      gap();
      units.push_back({{bytes.begin(), bytes.end()}, frame_time});
      continue;
    }
    if (piece_.time != time) {
      good = good && piece_.bytes.empty();
      piece_ = {{}, time};
    }
    append(piece_.bytes, bytes);
    if (piece_.bytes.size() > size) gap();
    if (piece_.bytes.size() == size) {
      units.push_back(std::move(piece_));
      gap();
    }
    return good;
  }
  return good;
}

}  // namespace animeme::media
