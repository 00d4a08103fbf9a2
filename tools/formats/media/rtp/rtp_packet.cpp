#include "tools/formats/media/rtp/rtp_packet.h"

#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::media {
namespace {

constexpr std::uint8_t kVersion = 2;
constexpr std::uint16_t kOneByteElements = 0xBEDE;
constexpr std::uint16_t kTwoByteElements = 0x1000;  // the low four bits are free
constexpr std::size_t kBundleEntry = 6;

// Element header, entries, zeros up to a whole word.
std::size_t extension_words(std::size_t entries) { return (2 + entries * kBundleEntry + 3) / 4; }

void write_extension(ByteVector& out, const std::vector<BundledPlane>& bundle) {
  const std::size_t words = extension_words(bundle.size());
  put(out, kTwoByteElements, 2);
  put(out, words, 2);
  const std::size_t end = out.size() + words * 4;
  put(out, kBundleExtensionId, 1);
  put(out, bundle.size() * kBundleEntry, 1);
  for (const BundledPlane& plane : bundle) {
    put(out, plane.previous_size, 2);
    put(out, plane.delay, 4);
  }
  out.resize(end);
}

void read_bundle(ByteSpan data, RtpPacket& packet) {
  if (data.size() % kBundleEntry != 0 || data.size() / kBundleEntry >= kMaxBundle) return;
  WireReader in(data);
  while (in.left() > 0) {
    BundledPlane plane;
    plane.previous_size = in.u16();
    plane.delay = in.u32();
    packet.bundle.push_back(plane);
  }
}

// Elements of RFC 8285; damage ends the list, the packet stays good.
void read_extension(std::uint16_t profile, ByteSpan data, int bundle_id, RtpPacket& packet) {
  const bool one_byte = profile == kOneByteElements;
  if (bundle_id == 0 || (!one_byte && (profile & 0xFFF0) != kTwoByteElements)) return;
  WireReader in(data);
  while (in.left() > 0) {
    const std::uint8_t head = in.u8();
    if (head == 0) continue;  // padding
    const int id = one_byte ? head >> 4 : head;
    const std::size_t size = one_byte ? (head & 15u) + 1u : in.u8();
    const ByteSpan element = in.take(size);
    if (in.failed() || (one_byte && id == 15)) return;
    if (id == bundle_id) read_bundle(element, packet);
  }
}

bool bundle_fits(const RtpPacket& packet) {
  std::size_t sum = 0;
  for (const BundledPlane& plane : packet.bundle) {
    if (plane.previous_size == 0) return false;
    sum += plane.previous_size;
  }
  return packet.bundle.empty() || sum < packet.payload.size();
}

}  // namespace

std::size_t rtp_header_size(std::size_t planes) {
  return planes <= 1 ? kRtpHeaderSize : kRtpHeaderSize + 4 + 4 * extension_words(planes - 1);
}

std::vector<std::uint8_t> write_rtp(const RtpPacket& packet) {
  ByteVector out;
  out.reserve(rtp_header_size(packet.bundle.size() + 1) + packet.payload.size());
  put(out, kVersion << 6 | (packet.bundle.empty() ? 0 : 0x10), 1);
  put(out, (packet.marker ? 0x80u : 0u) | (packet.payload_type & 0x7Fu), 1);
  put(out, packet.sequence, 2);
  put(out, packet.timestamp, 4);
  put(out, packet.ssrc, 4);
  if (!packet.bundle.empty()) write_extension(out, packet.bundle);
  append(out, packet.payload);
  return out;
}

std::optional<RtpPacket> read_rtp(std::span<const std::uint8_t> datagram, int bundle_id) {
  if (looks_like_rtcp(datagram)) return std::nullopt;
  WireReader in(datagram);
  RtpPacket packet;
  const std::uint8_t flags = in.u8();
  const std::uint8_t type = in.u8();
  packet.marker = (type & 0x80) != 0;
  packet.payload_type = type & 0x7F;
  packet.sequence = in.u16();
  packet.timestamp = in.u32();
  packet.ssrc = in.u32();
  in.take(4 * std::size_t(flags & 15));  // contributing sources
  if ((flags & 0x10) != 0) {
    const std::uint16_t profile = in.u16();
    const std::size_t words = in.u16();
    read_extension(profile, in.take(4 * words), bundle_id, packet);
  }
  if (in.failed() || flags >> 6 != kVersion) return std::nullopt;
  ByteSpan payload = in.rest();
  if ((flags & 0x20) != 0) {
    if (payload.empty() || payload.back() == 0 || payload.back() > payload.size()) {
      return std::nullopt;
    }
    payload = payload.first(payload.size() - payload.back());
  }
  packet.payload.assign(payload.begin(), payload.end());
  if (!bundle_fits(packet)) return std::nullopt;
  return packet;
}

bool looks_like_rtcp(std::span<const std::uint8_t> datagram) {
  return datagram.size() >= 8 && datagram[0] >> 6 == kVersion && datagram[1] >= 192 &&
         datagram[1] <= 223;
}

}  // namespace animeme::media
