/// @file
/// Splits long recordings into sentences at pauses.
#pragma once

#include <cstddef>
#include <vector>

#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "tools/formats/media/pcm.h"

namespace animeme::tools {

/// A part of a recording, in frames of its curves: [first, last).
struct Stretch {
  std::size_t first = 0;  ///< first frame
  std::size_t last = 0;   ///< one past the last
};

/// The sentences of a recording of `frames` frames at `rate`. Stretches longer than `most` seconds
/// are split recursively in the middle of the longest pause (at least 0.12 s) that leaves 2 s of
/// sound on both sides, if there is one. At most half a second of pause is kept at the ends of a
/// sentence. Returns one stretch of all frames if nothing is split.
std::vector<Stretch> cut_at_pauses(const dam::Script& script, fap::Rate rate, std::size_t frames,
                                   double most);

/// The phones of a stretch, from 0 s on.
dam::Script part_of(const dam::Script& script, fap::Rate rate, Stretch stretch);
/// Its frames.
dam::Signal part_of(const dam::Signal& signal, Stretch stretch);
/// Its sound.
media::Pcm part_of(const media::Pcm& sound, fap::Rate rate, Stretch stretch);

}  // namespace animeme::tools
