/// @file
/// Motion for uncertain speech: the mean over possible readings. A phone that only some readings
/// have moves the face by their share, so doubt causes small motions, not wrong ones. Source:
/// tools/speech/voice/engines.md, section 3.
#pragma once

#include <cstddef>
#include <span>

#include "dam/model/model.h"
#include "dam/script/script.h"
#include "dam/signal/signal.h"
#include "dam/speaking/synthesise.h"
#include "fap/result.h"

namespace animeme::dam {

/// A range of frames of scripts that may continue.
struct ReadingFrames {
  std::size_t first = 0;  ///< number of the first frame
  std::size_t count = 0;  ///< number of frames
};

/// The mean of synthesise() over `readings`, all equally likely, with the lips closed where
/// `agreed` has P, B or M and at the teeth where it has F or V. All scripts must have the same
/// duration. The report is that of `agreed`. Errors: invalid_argument (no reading), those of
/// synthesise().
Result<Signal> synthesise_readings(const Model& model, std::span<const Script> readings,
                                   const Script& agreed, const SynthesisOptions& options = {},
                                   SynthesisReport* report = nullptr);

/// The same for some frames while the speech continues: silence follows the scripts, and the face
/// need not rest at either end. `options.frames` and `tail` are not used.
Result<Signal> synthesise_readings(const Model& model, std::span<const Script> readings,
                                   const Script& agreed, const SynthesisOptions& options,
                                   const ReadingFrames& frames);

}  // namespace animeme::dam
