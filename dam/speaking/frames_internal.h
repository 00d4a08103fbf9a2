// Synthesis of a piece of a clip, for whole clips and for streams.
#pragma once

#include <cstddef>

#include "dam/speaking/synthesise.h"

namespace animeme::dam {

struct FramePlan {
  std::size_t first = 0;  ///< number of the first frame to make
  std::size_t count = 0;
  double last_frame = 0;  ///< seconds: where the clip ends; infinity: not known yet
};

/// synthesise() for some frames; options and script are valid already. The frames are those of the
/// whole clip as long as nothing outside the piece reaches into it.
Result<Signal> synthesise_frames(const Model& model, const Script& script,
                                 const SynthesisOptions& options, const FramePlan& plan,
                                 SynthesisReport& report);

}  // namespace animeme::dam
