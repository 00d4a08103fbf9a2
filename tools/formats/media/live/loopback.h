/// @file
/// A sink and a source connected in memory, with optional losses, for tests of code that uses them.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// Simulated losses.
struct LoopbackOptions {
  double loss = 0;         ///< share of units that do not arrive, 0..1
  std::uint64_t seed = 1;  ///< of the losses: the same seed loses the same units
};

/// Both ends of one presentation. They may be used one after the other or alternately, in one
/// thread. Units are kept until the source reads them. Losses appear as a LiveGap before the next
/// unit of the track.
struct Loopback {
  std::unique_ptr<LiveSink> sink;      ///< writes
  std::unique_ptr<LiveSource> source;  ///< reads what it wrote
};
/// Both ends may be used from one thread.
Loopback make_loopback(const LoopbackOptions& options = {});

}  // namespace animeme::media
