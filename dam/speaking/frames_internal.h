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

/// Where the script says P, B, M, F or V the lips meet each other or the teeth, unless the options
/// say no; times of the script are those of the signal.
void touch_lips(const Model& model, const Script& script, const SynthesisOptions& options,
                Signal& signal, SynthesisReport& report);

}  // namespace animeme::dam
