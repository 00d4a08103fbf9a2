/// @file
/// A sink and a source that are joined in memory, with losses where they are wanted: for tests of
/// what stands before a sink and behind a source.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// What goes wrong on the way.
struct LoopbackOptions {
  double loss = 0;         ///< share of units that do not arrive, 0..1
  std::uint64_t seed = 1;  ///< of the losses: the same seed loses the same units
};

/// Both ends of one presentation. They may be used after each other or in turn, in one thread.
/// What is sent before the source looks is kept. Losses show as a LiveGap before the next unit
/// of the track.
struct Loopback {
  std::unique_ptr<LiveSink> sink;      ///< writes
  std::unique_ptr<LiveSource> source;  ///< reads what it wrote
};
/// Both ends may be used from one thread.
Loopback make_loopback(const LoopbackOptions& options = {});

}  // namespace animeme::media
