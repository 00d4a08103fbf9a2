/// @file
/// A face and its sound over RTP: MP4V-ES planes and AAC or Opus, with RTCP for lip sync and loss.
///
///     auto sink = make_rtp_sink("rtp://192.0.2.7:5004", {.sdp_path = "talk.sdp"});
///     auto source = make_rtp_source("talk.sdp");          // on the other machine
///
/// The face goes to the port of the address, its RTCP to the port after it; sound and its RTCP to
/// the two after those. Both ends answer reports to where they came from.
/// Source: RFC 3550 (RTP, RTCP), 6416 (MP4V-ES), 3640 (AAC), 7587 (Opus), 8285 (header extension),
/// 8866 (SDP), 7273 (media clock); tools/formats/media/containers.md, sections 4.1 and 4.2.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// How a presentation is sent.
struct RtpOptions {
  int mtu = 1400;  ///< largest datagram, bytes of UDP payload, 256..65000; larger planes are split
  /// How often each packet of the face is sent, 1..8. Planes are smaller than their headers, and a
  /// lost one corrupts the face up to the next intra plane, hence 2. Receivers that do not drop
  /// duplicates need 1 (a bare `rtpmp4vdepay` of GStreamer without `rtpjitterbuffer`; FFmpeg drops
  /// all except copies directly after their original, which are sent if no plane follows for 0.2 s
  /// and at the end).
  int repeat = 2;
  /// A copy follows its original by so many further packets of the face, 1..50, the next copy by
  /// twice as many, so that only a burst of that length loses them all. If no plane follows for 0.2
  /// s, copies are sent. A loss costs that much delay; our receivers adapt their wait.
  int repeat_after = 3;
  /// Planes per packet, 1..16. More planes save headers but add delay. Their sizes and times go
  /// into an RTP header extension that the session description announces; receivers without it get
  /// the planes in order, all with the time of the first. Intra planes begin a packet.
  int bundle = 1;
  int audio_bundle = 1;          ///< AAC frames a packet, 1..32; Opus: always 1
  bool config_in_band = true;    ///< repeat the configuration before each intra plane
  std::string sdp_path;          ///< start() writes the session description here; empty: none
  std::string name = "animeme";  ///< of the session
  int ttl = 1;                   ///< hops of multicast packets, 0..255
  std::string interface;         ///< address (IPv4) or name (IPv6) for multicast; empty: default
  /// Determines identifiers, names, first sequence numbers and timestamps; nullopt: random, as RFC
  /// 3550 requires.
  std::optional<std::uint64_t> seed;
};

/// How a presentation is received.
struct RtpReceiveOptions {
  /// Initial and minimum wait for an earlier packet, seconds, 0..10. It grows when packets or their
  /// copies are later than that, and shrinks slowly when they no longer are.
  double reorder_seconds = 0.1;
  double reorder_most_seconds = 1;  ///< maximum wait, 0..10
  int reorder_packets = 256;        ///< maximum number of waiting packets, 0..1000
  /// Maximum wait at the start for the sender reports that synchronise face and sound, 0..10. Not
  /// needed if the session description has the media clock, as ours does.
  double sync_seconds = 0.5;
  bool send_reports = true;  ///< receiver reports back to the sender, and intra requests (PLI)
  /// Allows a sender to use several addresses and ports (a farm of relays). Anyone who can see its
  /// packets can then impersonate it.
  bool any_source = false;
  std::string interface;  ///< as RtpOptions::interface
};

/// Sends to "rtp://host:port" (port even, default 5004; IPv6 in brackets; may be a multicast
/// address). Errors: invalid_argument (address, options), io (no such host, sockets). The sink's
/// own errors: invalid_argument (a unit before start(), without bytes, for a track that info does
/// not have, audio packets larger than a datagram), io.
Result<std::unique_ptr<LiveSink>> make_rtp_sink(const std::string& url,
                                                const RtpOptions& options = {});

/// Receives the session of a description file, or of "rtp://address:port", which binds the port
/// (host empty, 0.0.0.0 or [::]: all addresses; a multicast group is joined) and accepts a face
/// only, with the configuration before its intra planes.
///
/// Accepts one sender, from one address and port (see rtp_input.h): the described one if it sends,
/// else the first valid one. When it has been silent for a second, another active sender takes over
/// (LiveRestart). The description is reread when its file changes.
///
/// Times: face times are in the timescale of the sender's LiveInfo if the description has it (ours
/// do) and are exactly those sent if that is at most 90000; other face times are ticks of 1/90000
/// s. Durations follow from the rate and the skip count in the planes. Time 0 is the sender's if
/// the description is that of the running sender, else the first plane received.
///
/// Errors: invalid_argument (options), not_found, io (address in use ...), syntax (not a session
/// description), unsupported (no supported face or sound).
Result<std::unique_ptr<LiveSource>> make_rtp_source(const std::string& where,
                                                    const RtpReceiveOptions& options = {});

}  // namespace animeme::media
