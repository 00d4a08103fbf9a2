/// @file
/// One clock for face and sound, whose RTP times begin at independent random numbers.
/// Source: RFC 3550 section 6.4.1 (sender reports), RFC 7273 (media clock in the description).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tools/formats/media/live/live.h"
#include "tools/formats/media/rtp/jitter.h"
#include "tools/formats/media/rtp/rtcp.h"

namespace animeme::media {

/// How the tracks are synchronised, from worst to best.
enum class RtpSync : std::uint8_t {
  none,         ///< nothing yet
  arrival,      ///< by time of arrival; wrong by the delays of sender and network
  reports,      ///< by sender reports of both
  description,  ///< the session description defines time 0
};

/// Tracks by LiveTrack. A presentation of one track has time 0 at its first packet unless it is
/// described.
class RtpTimeline {
 public:
  /// Clocks in ticks a second, 0: no such track. `patience`: seconds to wait for sender reports
  /// of both.
  RtpTimeline(std::uint32_t face_clock, std::uint32_t audio_clock, double patience);

  /// Adds a packet; returns its unwrapped time.
  std::int64_t add(LiveTrack track, std::uint32_t timestamp, double now);
  void add_report(LiveTrack track, const SenderInfo& report);  ///< times of a sender report
  /// RTP time at time 0 from the description; nullopt: the description is that of another sender.
  /// Used if all tracks have it.
  void describe(LiveTrack track, std::optional<std::uint32_t> offset);
  void restart();  ///< another sender: resets everything

  /// Are times available? Always true after the wait.
  bool settle(double now);
  /// When settle() becomes true without further packets; nullopt: it is true, or no packet has
  /// arrived.
  std::optional<double> deadline() const;
  RtpSync sync() const { return sync_; }  ///< how the tracks are synchronised
  /// Ticks of the track's clock since time 0, of a time from add(). Only when settled. Three
  /// consecutive reports that agree with each other and contradict the current clock by more than
  /// 20 ms shift the sound from then on; after synchronisation by arrival one report is enough.
  /// Reports are ignored if they place face and sound that arrived together more than ten seconds
  /// apart.
  std::int64_t time(LiveTrack track, std::int64_t unwrapped);

 private:
  struct Track {
    std::uint32_t clock = 0;
    Unwrapper unwrapper;
    bool heard = false;
    std::int64_t last = 0;
    std::int64_t first = 0;
    double first_arrival = 0;
    std::optional<std::uint32_t> offset;
    std::optional<SenderInfo> raw_report;  // came before the first packet
    std::optional<std::uint64_t> ntp;      // the last report, and the RTP time with it
    std::int64_t reported = 0;
    std::optional<std::int64_t> zero;  // RTP time at time 0
  };
  Track& of(LiveTrack track) { return tracks_[std::size_t(track)]; }
  static void take_report(Track& track, const SenderInfo& report);
  bool all(bool (*test)(const Track&)) const;
  void set_zero(Track& track);
  std::int64_t zero_by_reports(const Track& track, const Track& other) const;
  static std::int64_t zero_by_arrival(const Track& track, const Track& other);
  void check_against_reports();
  bool is_credible(const Track& track, const Track& other, std::int64_t zero) const;

  std::array<Track, 2> tracks_;
  double patience_;
  RtpSync sync_ = RtpSync::none;
  std::int64_t proposed_ = 0;  // RTP time of the sound at time 0, by the last reports
  int proposals_ = 0;          // how many reports in a row have said so
};

}  // namespace animeme::media
