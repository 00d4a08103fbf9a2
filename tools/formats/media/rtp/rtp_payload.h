/// @file
/// Converts access units to RTP payloads and back. Source: RFC 6416 section 5 (MP4V-ES), RFC 3640
/// section 3.3.6 (AAC-hbr), RFC 7587 section 4.2 (Opus); tools/formats/media/containers.md, section
/// 4.1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/formats/media/rtp/rtp_packet.h"

namespace animeme::media {

/// One outgoing payload.
struct RtpPayload {
  std::vector<std::uint8_t> bytes;  ///< after the RTP header
  bool marker = false;              ///< the last, or only, piece of its access unit
};

/// Splits a plane into packets of at most `room` (> 0) bytes, all with one timestamp, the last one
/// marked.
std::vector<RtpPayload> split_plane(std::span<const std::uint8_t> plane, std::size_t room);

/// Packs AAC frames into one packet of at most `room` (> 4) bytes: headers of 13 + 3 bits, then the
/// frames. Only a single frame may be larger; it is split into several packets. Frames have 1..8191
/// bytes.
std::vector<RtpPayload> pack_aac(std::span<const std::vector<std::uint8_t>> frames,
                                 std::size_t room);
inline constexpr std::size_t kMaxAacFrame = 8191;  ///< 13 bits of size
/// Size of such a packet with `frames` frames of `bytes` in total.
std::size_t aac_packet_size(std::size_t frames, std::size_t bytes);

/// A received access unit, its time in ticks of the RTP clock.
struct RtpUnit {
  std::vector<std::uint8_t> bytes;  ///< joined, complete
  std::int64_t time = 0;            ///< unwrapped

  friend bool operator==(const RtpUnit&, const RtpUnit&) = default;
};

/// Reassembles planes. Holds at most 1 MB.
class PlaneJoiner {
 public:
  /// The next packet in order, its time unwrapped. Complete planes are appended to `units`. false:
  /// a plane was dropped without a reported gap.
  bool add(const RtpPacket& packet, std::int64_t time, std::vector<RtpUnit>& units);
  /// Packets are missing here: drops a plane that has not been marked complete.
  void gap();

 private:
  RtpUnit unit_;
  bool open_ = false;      // unit_ waits for its mark
  bool skipping_ = false;  // the begin of the plane at unit_.time is lost
};

/// Field widths of mpeg4-generic, from the session description.
struct AacFields {
  int size_bits = 13;        ///< sizelength
  int index_bits = 3;        ///< indexlength
  int index_delta_bits = 3;  ///< indexdeltalength

  friend bool operator==(const AacFields&, const AacFields&) = default;
};

/// Extracts AAC frames from packets and joins fragments. Holds at most 64 kB.
class AacJoiner {
 public:
  /// `frame_samples`: ticks of a frame.
  AacJoiner(AacFields fields, int frame_samples) : fields_(fields), samples_(frame_samples) {}
  /// Appends what is complete; false: the packet is broken.
  bool add(const RtpPacket& packet, std::int64_t time, std::vector<RtpUnit>& units);
  void gap() { piece_.bytes.clear(); }  ///< drops an incomplete frame

 private:
  AacFields fields_;
  int samples_;
  RtpUnit piece_;  // begin of a frame that is larger than a packet; empty: none
};

}  // namespace animeme::media
