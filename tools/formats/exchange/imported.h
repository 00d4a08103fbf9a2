/// @file
/// What the readers of this folder give: motion, and what a person should know about it.
#pragma once

#include <string>
#include <vector>

#include "fap/frame.h"

namespace animeme::exchange {

/// A recording of another program as a clip, which has one frame at least. It has no name; frames
/// are numbered from 0, and numbers that are not there are skipped frames (fap/frame.h).
struct Imported {
  fap::Sequence clip;  ///< FAPs
  /// Sentences for people, without a full stop: what was left out, guessed or assumed. Where the
  /// user can do something about it, the option of `animeme import` is named.
  std::vector<std::string> warnings;
};

}  // namespace animeme::exchange
