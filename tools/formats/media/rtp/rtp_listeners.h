/// @file
/// Who listens to a sender, by the reports that come back.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "tools/formats/media/live/live.h"
#include "tools/formats/media/rtp/rtcp.h"

namespace animeme::media {

/// At most 4096; one who has not reported for 30 seconds is forgotten.
class RtpListeners {
 public:
  /// `reporter` says of this track that it lost this share of packets.
  void add(std::uint32_t reporter, LiveTrack track, const ReportBlock& block, double now);
  void remove(std::uint32_t reporter) { listeners_.erase(reporter); }  ///< it said goodbye

  std::int64_t count(double now) const;  ///< heard of lately
  /// Mean over listeners of the worse of their tracks; 0..1.
  double loss(double now) const;

 private:
  struct Listener {
    double heard = 0;
    std::array<double, 2> loss{};  // by LiveTrack
  };
  std::map<std::uint32_t, Listener> listeners_;
};

}  // namespace animeme::media
