/// @file
/// Changes of motion by edit: what needs the planes to be coded again.
#pragma once

#include <optional>
#include <vector>

#include "codec/text/bap_text.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/app/commands/edit_options.h"
#include "tools/app/commands/edit_source.h"

namespace animeme::tools {

/// What is changed, in this order.
struct EditChanges {
  double speed = 1;                ///< of the motion
  double cross_fade = 0;           ///< seconds, at joints and where a taken part ends
  std::int64_t hold = 0;           ///< frames for which the first one is held, at `rate`
  bool mirror = false;             ///< left and right
  std::vector<EditTake> takes;     ///< parts of other files; no rest
  std::vector<EditAmount> scale;   ///< factors
  std::vector<EditAmount> smooth;  ///< seconds
  double fade_in = 0;              ///< seconds
  double fade_out = 0;             ///< seconds

  /// Some value changes.
  bool any() const {
    return speed != 1 || cross_fade > 0 || mirror || !takes.empty() || !scale.empty() ||
           !smooth.empty() || fade_in > 0 || fade_out > 0;
  }
};

/// A face and a body, complete frame by frame.
struct EditedMotion {
  fap::Sequence face;      ///< no frames: there is none
  fba::BodySequence body;  ///< likewise
};

/// Joins cuts at a rate and changes them. Errors: those of read_edit_source() for files of takes.
Result<EditedMotion> change_motion(const std::vector<EditCut>& cuts, fap::Rate rate,
                                   const EditChanges& changes);

}  // namespace animeme::tools
