/// @file
/// Packs the units of one track into RTP packets: sequence numbers, timestamps, fragments, bundles.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/formats/media/live/live.h"
#include "tools/formats/media/rtp/rtp.h"
#include "tools/formats/media/rtp/rtp_packet.h"
#include "tools/formats/media/rtp/rtp_payload.h"

namespace animeme::media {

/// Chosen at random when a sender starts, RFC 3550 section 5.1.
struct RtpIdentity {
  std::uint32_t ssrc = 0;      ///< of the sender
  std::uint32_t offset = 0;    ///< RTP time at time 0
  std::uint16_t sequence = 0;  ///< of the first packet
};

/// Collects units until a packet is full, and numbers packets.
class RtpPacketizer {
 public:
  /// Requires that `info` has this track and that options are valid.
  RtpPacketizer(LiveTrack track, const LiveInfo& info, const RtpOptions& options,
                const RtpIdentity& identity, std::uint8_t payload_type);

  LiveTrack track() const { return track_; }                 ///< track of the units
  std::uint32_t clock() const { return clock_; }             ///< of RTP times, ticks a second
  std::uint32_t ssrc() const { return identity_.ssrc; }      ///< of the packets
  std::uint32_t offset() const { return identity_.offset; }  ///< RTP time at time 0
  std::uint32_t packets() const { return packets_; }         ///< made so far
  std::uint32_t octets() const { return octets_; }           ///< their payload
  /// Seconds of a time or duration of LiveUnit.
  double seconds(std::int64_t time) const { return double(time) / timescale_; }

  /// Errors: invalid_argument (a unit without bytes; AAC over 8191 bytes, Opus over a datagram).
  Result<void> check(const LiveUnit& unit) const;
  /// Does this unit fit into a packet with the pending ones? Otherwise call flush() first.
  bool fits(const LiveUnit& unit) const;
  void add(const LiveUnit& unit);  ///< requires fits() and check()
  /// As many units are pending as a packet may have.
  bool full() const { return int(units_.size()) >= most_; }
  bool empty() const { return units_.empty(); }  ///< nothing is pending
  int most() const { return most_; }             ///< units of a packet at most
  /// Makes packets of the pending units.
  std::vector<std::vector<std::uint8_t>> flush();

 private:
  std::int64_t ticks(const LiveUnit& unit) const;
  std::vector<RtpPayload> face_payloads(RtpPacket& packet) const;
  std::vector<RtpPayload> audio_payloads() const;

  LiveTrack track_;
  RtpIdentity identity_;
  std::uint8_t payload_type_;
  std::uint32_t clock_;
  std::uint32_t timescale_;
  bool opus_ = false;
  std::size_t mtu_;
  int most_ = 1;                      // units a packet
  std::vector<std::uint8_t> config_;  // in front of intra planes
  std::vector<LiveUnit> units_;
  std::size_t bytes_ = 0;
  std::uint32_t packets_ = 0;
  std::uint32_t octets_ = 0;
};

}  // namespace animeme::media
