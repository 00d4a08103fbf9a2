/// @file
/// One RTP packet: header, payload, and the header extension that locates the planes of a bundle.
/// Source: RFC 3550 section 5.1, RFC 8285 section 4.3.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// A plane of a packet after the first one.
struct BundledPlane {
  std::uint16_t previous_size = 0;  ///< bytes of the previous plane
  std::uint32_t delay = 0;          ///< ticks of the RTP clock after the packet's time

  friend bool operator==(const BundledPlane&, const BundledPlane&) = default;
};

inline constexpr std::size_t kMaxBundle = 16;  ///< planes of a packet
/// Name of the extension in the session description.
inline constexpr const char* kBundleExtension = "urn:x-animeme:planes";
inline constexpr std::uint8_t kBundleExtensionId = 1;  ///< between 1 and 14

/// One packet; see write_rtp() and read_rtp().
struct RtpPacket {
  bool marker = false;                ///< last packet of an access unit
  std::uint8_t payload_type = 96;     ///< 0..127
  std::uint16_t sequence = 0;         ///< counts packets modulo 2^16
  std::uint32_t timestamp = 0;        ///< ticks modulo 2^32
  std::uint32_t ssrc = 0;             ///< of the sender
  std::vector<BundledPlane> bundle;   ///< empty: the packet has no extension; at most 15
  std::vector<std::uint8_t> payload;  ///< starting with the first plane

  friend bool operator==(const RtpPacket&, const RtpPacket&) = default;
};

inline constexpr std::size_t kRtpHeaderSize = 12;  ///< bytes, without extension
/// Bytes of header and extension for the given number of planes (1: no extension).
std::size_t rtp_header_size(std::size_t planes);

/// The bytes on the wire.
std::vector<std::uint8_t> write_rtp(const RtpPacket& packet);

/// Reads a datagram. Contributing sources and padding are skipped, and so are extensions except
/// number `bundle_id` (0: none). nullopt: no RTP packet (version, truncated header or extension,
/// padding longer than the payload, a bundle longer than the payload), or RTCP.
std::optional<RtpPacket> read_rtp(std::span<const std::uint8_t> datagram, int bundle_id = 0);

/// A datagram of one track, RTP or RTCP.
struct RtpDatagram {
  LiveTrack track = LiveTrack::face;  ///< track of the datagram
  bool control = false;               ///< RTCP
  std::vector<std::uint8_t> bytes;    ///< one UDP payload

  friend bool operator==(const RtpDatagram&, const RtpDatagram&) = default;
};

/// Is this datagram RTCP (which some senders mix into the port of the medium)? RFC 5761.
bool looks_like_rtcp(std::span<const std::uint8_t> datagram);

}  // namespace animeme::media
