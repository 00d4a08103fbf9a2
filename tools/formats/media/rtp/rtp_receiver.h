/// @file
/// RTP and RTCP reception without sockets: the caller passes datagrams and the time, and takes
/// events and reports.
///
///     RtpReceiver receiver(*read_sdp(text), {}, 1);
///     receiver.rtp(LiveTrack::face, datagram, from, seconds);
///     while (auto event = receiver.next(seconds)) { ... }
///
/// Safe for untrusted input. Queues at most 8 MB, besides what RtpInput keeps for a track (2 MB at
/// most); if the caller does not take events, further units are dropped and reported as a gap.
/// rtp_input.h documents which sender is accepted. When one track has a new sender, both restart: a
/// LiveRestart separates the events of the old and the new one.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tools/formats/media/rtp/rtp.h"
#include "tools/formats/media/rtp/rtp_input.h"
#include "tools/formats/media/rtp/rtp_timeline.h"
#include "tools/formats/media/rtp/rtp_units.h"
#include "tools/formats/media/rtp/sdp.h"

namespace animeme::media {

/// Receives both media of a session.
class RtpReceiver {
 public:
  /// `id`: own identifier in reports. Times ("now") are seconds of any steady clock.
  RtpReceiver(const RtpSession& session, const RtpReceiveOptions& options, std::uint32_t id);

  /// Takes an RTP datagram, which may be invalid. Pass all datagrams available in a socket before
  /// calling next(), since next() gives up missing packets when they are due.
  void rtp(LiveTrack track, std::span<const std::uint8_t> datagram, const UdpAddress& from,
           double now);
  /// Takes an RTCP datagram, which may be invalid. true: it was a report of the sender.
  bool rtcp(LiveTrack track, std::span<const std::uint8_t> datagram, const UdpAddress& from,
            double now);
  /// Whether a datagram is from the accepted sender of a track (RTCP: always), not from a potential
  /// one.
  bool hears(LiveTrack track, std::span<const std::uint8_t> datagram, const UdpAddress& from) const;
  /// Ends reception: packets that wait for others, or for synchronisation, become ready.
  void flush(double now);
  /// The next event, never LiveIdle. nullopt: nothing is ready.
  std::optional<LiveEvent> next(double now);
  /// When next() returns something even without a further datagram; in the past: now.
  std::optional<double> deadline() const;
  /// Receiver reports that are due: about every five seconds. Where planes are missing, requests
  /// for an intra plane, at once and every quarter of a second until one arrives.
  std::vector<RtpDatagram> reports(double now);

  ReceiveStats stats() const;                        ///< of both media
  RtpSync sync() const { return timeline_.sync(); }  ///< how the two clocks were synchronised
  /// Datagrams of potential senders of a track, see RtpInput::early().
  std::vector<RtpInput::Early> early(LiveTrack track) const;

 private:
  struct Source {
    LiveTrack track = LiveTrack::face;
    RtpInput input;
    double next_report = 0;
    bool begun = false;  // a unit has come since the sender began
  };

  Source* source(LiveTrack track);
  const Source* source(LiveTrack track) const;
  const RtpTrack& described(const Source& source) const;
  void describe(const Source& source);
  void drain(Source& source, double now);
  void add_units(Source& source, RtpUnits units);
  void push(LiveEvent event);
  LiveEvent pop(std::deque<LiveEvent>& queue);
  void restart(double now);
  LiveUnit timed(LiveUnit unit);
  LiveInfo info() const;
  std::optional<double> end_time() const;
  double report_interval();

  RtpSession session_;
  RtpReceiveOptions options_;
  std::uint32_t id_;
  std::uint32_t dice_;
  std::vector<Source> sources_;
  std::optional<FaceAssembler> face_;
  std::optional<AudioAssembler> audio_;
  RtpTimeline timeline_;
  std::uint32_t timescale_;
  std::deque<LiveEvent> pending_;  // with times of RTP
  std::deque<LiveEvent> ready_;    // what an earlier sender has left
  std::size_t waiting_bytes_ = 0;
  bool overflowed_ = false;
  bool wants_intra_ = true;  // none since planes are missing, or at all
  double next_request_ = 0;  // for an intra plane
  bool announced_ = false;
  bool ended_ = false;
  std::int64_t sessions_ = 0;
};

}  // namespace animeme::media
