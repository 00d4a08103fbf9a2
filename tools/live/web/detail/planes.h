// The small form of /faps: what changed, plane by plane. See protocol.md for the bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "fap/frame.h"

namespace animeme::web {

inline constexpr std::uint8_t kWhole = 4;  ///< flag: nothing is left of the planes before

/// Writes plane by plane; each message is what changed since the one before.
class PlaneWriter {
 public:
  struct Plane {
    std::uint64_t time = 0;      ///< ticks on the clock of the segments
    std::uint32_t duration = 0;  ///< ticks
    bool intra = false;          ///< written whole: readers can begin with it
    std::size_t bytes = 0;       ///< of the access unit
  };
  /// `face`: all of it, as Values::push() gives it.
  std::vector<std::uint8_t> write(const Plane& plane, const fap::Frame& face);

 private:
  fap::Frame before_;
  std::uint64_t time_ = 0;
  bool begun_ = false;
};

}  // namespace animeme::web
