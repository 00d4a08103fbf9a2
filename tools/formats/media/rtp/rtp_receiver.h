/// @file
/// What RTP and RTCP packets say, without sockets: a caller hands in datagrams and the time, and
/// takes out events and reports.
///
///     RtpReceiver receiver(*read_sdp(text), {}, 1);
///     receiver.rtp(LiveTrack::face, datagram, from, seconds);
///     while (auto event = receiver.next(seconds)) { ... }
///
/// Safe for whatever comes in. At most 8 MB wait in it, besides what RtpInput keeps of a track (2
/// MB at most); when the caller does not take them out, further units are dropped and reported as a
/// gap. Whom it hears is said in rtp_input.h. When one track has a new sender, both begin anew: a
/// LiveRestart stands between the events of the old and of the new one.
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

/// Both media of a session on their way in.
class RtpReceiver {
 public:
  /// `id`: own identifier in reports. Times ("now") are seconds of any steady clock.
  RtpReceiver(const RtpSession& session, const RtpReceiveOptions& options, std::uint32_t id);

  /// Takes an RTP datagram; anything may come. next() gives what it has brought: only once all that
  /// lies in a socket has been handed in, since next() gives up what is still missing when it is
  /// due.
  void rtp(LiveTrack track, std::span<const std::uint8_t> datagram, const UdpAddress& from,
           double now);
  /// Takes an RTCP datagram; anything may come. true: it was a report of the sender.
  bool rtcp(LiveTrack track, std::span<const std::uint8_t> datagram, const UdpAddress& from,
            double now);
  /// Whether a datagram is of the sender that is heard in a track (RTCP: always), rather than of
  /// one who may begin.
  bool hears(LiveTrack track, std::span<const std::uint8_t> datagram, const UdpAddress& from) const;
  /// Nobody is heard any more: what waits for others, or for a clock, is ready now.
  void flush(double now);
  /// The next event, never LiveIdle. nullopt: nothing is ready.
  std::optional<LiveEvent> next(double now);
  /// When next() will have something without a further datagram; in the past: now.
  std::optional<double> deadline() const;
  /// Receiver reports that are due: about every five seconds.
  std::vector<RtpDatagram> reports(double now);

  ReceiveStats stats() const;                        ///< of both media
  RtpSync sync() const { return timeline_.sync(); }  ///< how the two clocks were brought together
  /// Datagrams of a track that nobody was heard in, RtpInput::early().
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
  bool announced_ = false;
  bool ended_ = false;
  std::int64_t sessions_ = 0;
};

}  // namespace animeme::media
