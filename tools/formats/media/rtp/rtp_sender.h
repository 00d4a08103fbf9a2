/// @file
/// RTP and RTCP sending without sockets: the caller passes units and the time, and sends the
/// resulting datagrams.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/formats/media/rtp/rtcp.h"
#include "tools/formats/media/rtp/rtp.h"
#include "tools/formats/media/rtp/rtp_listeners.h"
#include "tools/formats/media/rtp/rtp_packetizer.h"
#include "tools/formats/media/rtp/sdp.h"

namespace animeme::media {

/// Errors: invalid_argument (an option outside its range; an empty presentation; a time scale of 0
/// or above kMaxTimescale; a sample rate of 0).
Result<void> check(const LiveInfo& info, const RtpOptions& options);

/// Intra planes on request come no oftener, whoever asks: anybody can send a request.
inline constexpr double kLeastIntraSeconds = 0.1;

/// Sends both media of a session.
class RtpSender {
 public:
  /// `address` and `port` go into the session description. `seed`: as RtpOptions::seed. `ntp`: the
  /// NTP time at `now` 0. Info and options must be valid.
  RtpSender(const LiveInfo& info, const RtpOptions& options, const std::string& address, int port,
            std::uint64_t seed, std::uint64_t ntp);

  /// For write_sdp().
  const RtpSession& session() const { return session_; }

  using Datagrams = std::vector<RtpDatagram>;  ///< in the order in which they are to be sent
  /// Appends the datagrams to send now. Times ("now") are seconds and ascend. Errors:
  /// invalid_argument (RtpPacketizer::check(), or a track that the presentation does not have).
  Result<void> send(const LiveUnit& unit, double now, Datagrams& out);
  /// Appends reports that are due, and units that have waited too long for the next one.
  void poll(double now, Datagrams& out);
  /// Appends the rest and a goodbye.
  void finish(double now, Datagrams& out);
  /// Takes a report of a receiver.
  void rtcp(std::span<const std::uint8_t> datagram, double now);

  /// LiveSink::intra_wanted(). Requests within kLeastIntraSeconds of the last answer wait.
  bool intra_wanted(double now);

  /// `packets` and `bytes` count RTCP, too.
  SendStats stats(double now) const;

 private:
  struct Track {
    RtpPacketizer packets;
    double next_report = 0;
    double gather_until = 0;
  };
  struct Copy {
    RtpDatagram datagram;
    int after = 0;  // planes, or bundles of them
  };

  void add_track(LiveTrack track, RtpTrack& described, const RtpIdentity& identity);
  Track* find(LiveTrack track);
  void flush(Track& track, double now, Datagrams& out);
  void send_copies(bool all, Datagrams& out);
  void report(Track& track, double now, bool bye, Datagrams& out);
  void emit(RtpDatagram datagram, Datagrams& out);

  LiveInfo info_;
  RtpOptions options_;
  RtpSession session_;
  std::uint64_t ntp_;
  std::vector<Track> tracks_;
  std::vector<Copy> copies_;
  double last_plane_ = 0;
  std::optional<double> zero_;  // when time 0 is, or was
  RtpListeners listeners_;
  SendStats stats_;
  bool intra_wanted_ = false;
  double intra_given_ = -kLeastIntraSeconds;             // when the last answer was
  std::map<std::uint32_t, std::uint8_t> full_requests_;  // by receiver: the last one
};

}  // namespace animeme::media
