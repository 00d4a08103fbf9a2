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
  /// How often each packet of the face is sent, 1..8. Planes are smaller than the headers around
  /// them, and a lost one spoils the face up to the next intra plane, hence 2. Receivers that do
  /// not drop duplicates want 1 (a bare `rtpmp4vdepay` of GStreamer without `rtpjitterbuffer`;
  /// FFmpeg drops all but copies right behind their original, which come where no plane follows for
  /// 0.2 s and at the end).
  int repeat = 2;
  /// A copy follows its original by so many further packets of the face, 1..50, the next copy by
  /// twice as many, so that a burst of losses has to last that long to take them all. Where no
  /// plane follows for 0.2 s, copies wait no longer. A loss costs that much delay; receivers of
  /// ours learn to wait so long.
  int repeat_after = 3;
  /// Planes a packet, 1..16. More save headers and cost delay. Their sizes and times go into an RTP
  /// header extension that the session description announces; receivers that do not know it see
  /// the planes in order, all with the time of the first. Intra planes begin a packet.
  int bundle = 1;
  int audio_bundle = 1;          ///< AAC frames a packet, 1..32; Opus: always 1
  bool config_in_band = true;    ///< the configuration in front of each intra plane
  std::string sdp_path;          ///< the session description goes here at start(); empty: nowhere
  std::string name = "animeme";  ///< of the session
  int ttl = 1;                   ///< hops of multicast packets, 0..255
  std::string interface;         ///< address (IPv4) or name (IPv6) for multicast; empty: default
  /// Identifiers, names, first sequence numbers and time stamps follow from it; nothing: random, as
  /// RFC 3550 asks for.
  std::optional<std::uint64_t> seed;
};

/// How a presentation is received.
struct RtpReceiveOptions {
  /// Time that a packet waits for an earlier one, seconds, 0..10: at first, and at least. It grows
  /// when packets, or their copies, come later than that, and shrinks slowly when they do no more.
  double reorder_seconds = 0.1;
  double reorder_most_seconds = 1;  ///< what it grows to at most, 0..10
  int reorder_packets = 256;        ///< at most so many wait, 0..1000
  /// Longest time to wait at the begin for the sender reports that tie face and sound together,
  /// 0..10. Not needed with a session description that has the media clock, as ours.
  double sync_seconds = 0.5;
  bool send_reports = true;  ///< receiver reports back to the sender
  /// One sender may send from several addresses and ports (a farm of relays). Anybody who can see
  /// what it sends can then speak in its place.
  bool any_source = false;
  std::string interface;  ///< as RtpOptions::interface
};

/// Sends to "rtp://host:port" (port even, default 5004; IPv6 in brackets; a multicast address will
/// do). Errors: invalid_argument (address, options), io (no such host, sockets).
/// The sink's own errors: invalid_argument (a unit before start(), without bytes, for a track that
/// info does not have, audio packets larger than a datagram), io.
Result<std::unique_ptr<LiveSink>> make_rtp_sink(const std::string& url,
                                                const RtpOptions& options = {});

/// Receives what a session description tells: a file, or "rtp://address:port", which binds the
/// port (host empty, 0.0.0.0 or [::]: all addresses; a multicast address is joined) and takes a
/// face alone, with the configuration in front of its intra planes.
///
/// Heard is one sender, from one address and port, as rtp_input.h has it: the first that proves to
/// be one, the one that was described before all others. When it is silent for a second, another
/// one that sends meanwhile takes over (LiveRestart). The description is read again when its file
/// changes.
///
/// Times: face times are in the timescale of the sender's LiveInfo if the description has it
/// (ours do) and come back exactly as they were sent if that is at most 90000; other face times are
/// ticks of 1/90000 s. Durations follow from the rate and the skip count in the planes. Time 0 is
/// the sender's if the description is that of the running sender, else the first plane received.
///
/// Errors: invalid_argument (options), not_found, io (address in use ...), syntax (no session
/// description), unsupported (neither a face nor a sound that is known here).
Result<std::unique_ptr<LiveSource>> make_rtp_source(const std::string& where,
                                                    const RtpReceiveOptions& options = {});

}  // namespace animeme::media
