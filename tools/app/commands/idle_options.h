/// @file
/// What a face does besides speaking: options of speak and stream.
#pragma once

#include <optional>

#include "dam/speaking/idle_motion.h"

namespace animeme::tools {

struct OptionTable;

/// What was asked for.
struct IdleOptions {
  std::optional<bool> on;         ///< --idle-motion, --no-idle-motion; nullopt: neither
  dam::IdleMotionOptions motion;  ///< --liveliness, --still, --look, --seed
};

/// Adds these options. `note`: what help says of the default.
void add_idle_options(OptionTable& cli, IdleOptions& options, const char* note);

}  // namespace animeme::tools
