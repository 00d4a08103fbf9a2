/// @file
/// Keeps track of a sender's receivers by their reports.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "tools/formats/media/live/live.h"
#include "tools/formats/media/rtp/rtcp.h"

namespace animeme::media {

/// At most 4096; one that has not reported for 30 seconds is removed.
class RtpListeners {
 public:
  /// Adds a report of `reporter` about this track.
  void add(std::uint32_t reporter, LiveTrack track, const ReportBlock& block, double now);
  void remove(std::uint32_t reporter) { listeners_.erase(reporter); }  ///< it said goodbye

  std::int64_t count(double now) const;  ///< that reported recently
  /// Mean over listeners of the worse of their tracks; 0..1.
  double loss(double now) const;
  double sound_loss(double now) const;  ///< of the one that lost most of the sound; 0..1

 private:
  struct Listener {
    double heard = 0;
    std::array<double, 2> loss{};  // by LiveTrack
  };
  std::map<std::uint32_t, Listener> listeners_;
};

}  // namespace animeme::media
