/// @file
/// RTCP: sender reports relate RTP times to a wall clock, to synchronise face and sound; receiver
/// reports inform the sender about losses. Source: RFC 3550 section 6, RFC 4585
/// section 6.3.1, RFC 5104 section 4.3.1.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace animeme::media {

/// What one receiver has seen of one sender.
struct ReportBlock {
  std::uint32_t ssrc = 0;      ///< of the sender
  std::uint8_t fraction = 0;   ///< of 256, lost since the last report
  std::int32_t lost = 0;       ///< since the start; 24 bits, saturated
  std::uint32_t highest = 0;   ///< sequence number with its count of wraps above
  std::uint32_t jitter = 0;    ///< ticks of the RTP clock
  std::uint32_t last_sr = 0;   ///< middle 32 bits of the NTP time of the last sender report
  std::uint32_t since_sr = 0;  ///< 1/65536 s since it arrived

  friend bool operator==(const ReportBlock&, const ReportBlock&) = default;
};

/// Sender information of a report.
struct SenderInfo {
  std::uint64_t ntp = 0;      ///< 32 bits of seconds since 1900, 32 bits of fraction
  std::uint32_t rtp = 0;      ///< the same instant
  std::uint32_t packets = 0;  ///< sent so far, modulo 2^32
  std::uint32_t octets = 0;   ///< of payload

  friend bool operator==(const SenderInfo&, const SenderInfo&) = default;
};

/// A sender report, or a receiver report if there is no sender information.
struct RtcpReport {
  std::uint32_t ssrc = 0;            ///< of the reporter
  std::optional<SenderInfo> sender;  ///< nullopt: a receiver report
  std::vector<ReportBlock> blocks;   ///< at most 31

  friend bool operator==(const RtcpReport&, const RtcpReport&) = default;
};

/// The name of a sender, the same for all its media.
struct RtcpName {
  std::uint32_t ssrc = 0;  ///< of the sender
  std::string cname;       ///< at most 255 bytes

  friend bool operator==(const RtcpName&, const RtcpName&) = default;
};

/// A receiver asks for an intra plane: picture loss indication (RFC 4585), or full intra request
/// (RFC 5104).
struct IntraRequest {
  std::uint32_t ssrc = 0;                ///< of the receiver
  std::uint32_t media = 0;               ///< of the sender
  std::optional<std::uint8_t> sequence;  ///< full intra request: the same in repeats of one request

  friend bool operator==(const IntraRequest&, const IntraRequest&) = default;
};

/// A compound packet. Written in this order.
struct RtcpMessage {
  std::vector<RtcpReport> reports;          ///< usually one
  std::vector<RtcpName> names;              ///< at most 31
  std::vector<std::uint32_t> byes;          ///< senders that leave; at most 31
  std::vector<IntraRequest> requests = {};  ///< each is a packet

  friend bool operator==(const RtcpMessage&, const RtcpMessage&) = default;
};

/// The bytes on the wire. RFC 3550 requires a report first, so there must be one.
std::vector<std::uint8_t> write_rtcp(const RtcpMessage& message);

/// Reads a datagram; packets of other types are ignored. nullopt: not RTCP, or one of its packets
/// is cut off.
std::optional<RtcpMessage> read_rtcp(std::span<const std::uint8_t> datagram);

/// The current NTP time by the system clock.
std::uint64_t ntp_now();
/// For identifiers that are unique on the network.
std::uint64_t random_number();

}  // namespace animeme::media
