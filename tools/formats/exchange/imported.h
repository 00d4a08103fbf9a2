/// @file
/// Result of the readers of this folder: motion and warnings.
#pragma once

#include <string>
#include <vector>

#include "fap/frame.h"

namespace animeme::exchange {

/// A recording of another program as a clip with at least one frame. It has no name; frames are
/// numbered from 0, and missing numbers are skipped frames (fap/frame.h).
struct Imported {
  fap::Sequence clip;  ///< FAPs
  /// Sentences for the user, without a full stop, about what was dropped, guessed or assumed. They
  /// name the option of `animeme import` that helps, if there is one.
  std::vector<std::string> warnings;
};

}  // namespace animeme::exchange
