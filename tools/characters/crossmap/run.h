/// @file
/// A whole project: recordings in, control curves out.
///
///     const auto made = animeme::crossmap::run(project);
///     for (const auto& take : made->takes) write(take.retarget.signal);
#pragma once

#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/characters/crossmap/capture.h"
#include "tools/characters/crossmap/keys.h"
#include "tools/characters/crossmap/project.h"
#include "tools/characters/crossmap/target.h"
#include "tools/formats/files/log.h"

namespace animeme::crossmap {

/// One recording.
struct Take {
  dam::Blend blend;        ///< as mixtures of the key shapes
  dam::Retarget retarget;  ///< as control curves
};

/// Result of a project.
struct Mapped {
  Capture capture;          ///< the recordings
  Keys keys;                ///< their key shapes
  Target target;            ///< the character
  std::vector<Take> takes;  ///< one per input
};

/// Runs all of Appendix A: loads, finds key shapes, fits frames, retargets. Deterministic. Errors:
/// those of load_capture(), load_keys(), load_target(), fit_blend() and fit_target().
Result<Mapped> run(const Project& project, const tools::Log& log = {});

/// RMS residual of a region over the frames of a recording in which it is visible, and the worst
/// frame.
struct RegionResidual {
  double rms = 0;         ///< units of the points
  double worst = 0;       ///< the largest of a frame
  std::size_t frame = 0;  ///< the worst frame
};
/// See RegionResidual; no check of the indices.
RegionResidual region_residual(const Mapped& mapped, std::size_t take, std::size_t region);

}  // namespace animeme::crossmap
