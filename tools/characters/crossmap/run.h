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

/// What came of a project.
struct Mapped {
  Capture capture;          ///< the recordings
  Keys keys;                ///< their key shapes
  Target target;            ///< the character
  std::vector<Take> takes;  ///< one an input
};

/// Does all of Appendix A: loads, finds key shapes, fits frames, retargets. Deterministic. Errors:
/// those of load_capture(), load_keys(), load_target(), fit_blend() and fit_target().
Result<Mapped> run(const Project& project, const tools::Log& log = {});

/// Root mean square of the residuals of a region over the frames of a recording in which it is
/// seen, and the frame that is off most.
struct RegionResidual {
  double rms = 0;         ///< units of the points
  double worst = 0;       ///< likewise, of one frame
  std::size_t frame = 0;  ///< which
};
/// See RegionResidual; no check of the indices.
RegionResidual region_residual(const Mapped& mapped, std::size_t take, std::size_t region);

}  // namespace animeme::crossmap
