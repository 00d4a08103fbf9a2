/// @file
/// Session descriptions: addresses and formats of the packets of a presentation.
/// Source: RFC 8866, 6416, 3640, 7587, 4585 and 5104 (rtcp-fb), 5576 (ssrc), 7273 (media clock),
/// 8285 (extmap); tools/formats/media/containers.md, section 4.1.
///
///     m=video 5004 RTP/AVP 96
///     a=rtpmap:96 MP4V-ES/90000
///     a=fmtp:96 profile-level-id=97; config=000001B061000001B58947
///     a=rtcp-fb:96 nack pli              intra planes that receivers ask for, also by ccm fir
///     a=ssrc:305419896 cname:animeme
///     a=mediaclk:direct=2271560481       RTP time of time 0
///     a=x-animeme:timescale=25000        private; others ignore it
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"
#include "tools/formats/media/rtp/rtp_payload.h"

namespace animeme::media {

inline constexpr std::uint32_t kFaceClock = 90000;  ///< ticks a second, of MP4V-ES
inline constexpr int kRtpPort = 5004;               ///< default port of the face
inline constexpr std::size_t kMaxConfig = 1024;     ///< bytes of a face's configuration
/// Largest LiveInfo::timescale; that of the fastest stream of 14496-2 is 4095000.
inline constexpr std::uint32_t kMaxTimescale = 10000000;

/// Common fields of face and sound.
struct RtpTrack {
  std::string address;      ///< usually numeric: "192.0.2.7", "ff15::1"
  int port = 0;             ///< 1..65534
  int rtcp_port = 0;        ///< usually port + 1
  int ttl = 0;              ///< of multicast packets; 0: not given
  int payload_type = 96;    ///< 0..127
  std::uint32_t clock = 0;  ///< ticks a second
  /// Sender; `clock_offset` is valid for this sender only.
  std::optional<std::uint32_t> ssrc;
  std::optional<std::uint32_t> clock_offset;  ///< RTP time at time 0

  friend bool operator==(const RtpTrack&, const RtpTrack&) = default;
};

/// The face in a description.
struct RtpFaceTrack : RtpTrack {
  std::vector<std::uint8_t> config;    ///< empty: in band
  std::uint8_t visual_profile = 0x61;  ///< profile-level-id
  std::uint32_t timescale = 0;         ///< of the sender; 0: not given
  int bundle_id = 0;                   ///< number of the extension kBundleExtension; 0: not used

  friend bool operator==(const RtpFaceTrack&, const RtpFaceTrack&) = default;
};

/// The sound in a description.
struct RtpAudioTrack : RtpTrack {
  AudioFormat format;  ///< codec, rate, channels
  AacFields fields;    ///< of mpeg4-generic

  friend bool operator==(const RtpAudioTrack&, const RtpAudioTrack&) = default;
};

/// Contents of a description.
struct RtpSession {
  std::string name = "animeme";        ///< s=
  std::string cname = "animeme";       ///< of both media, which identifies them as one session
  std::optional<RtpFaceTrack> face;    ///< nullopt: no face
  std::optional<RtpAudioTrack> audio;  ///< nullopt: no sound
  /// Unsupported media, one sentence each.
  std::vector<std::string> ignored;

  friend bool operator==(const RtpSession&, const RtpSession&) = default;
};

/// The text, lines ended by CR LF. Line ends in names become spaces.
std::string write_sdp(const RtpSession& session);

/// Reads descriptions of Animeme, FFmpeg, GStreamer or VLC: any line ends, any case of names;
/// unknown lines are ignored. The first supported face and the first supported sound are used.
/// Errors: syntax (no "v=0" and no "m=" line, an invalid number, larger than 64 kB; with line),
/// unsupported (no supported face or sound).
Result<RtpSession> read_sdp(std::string_view text);

}  // namespace animeme::media
