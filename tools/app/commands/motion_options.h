/// @file
/// How a face that speaks moves: options of speak, stream and follow.
#pragma once

#include "dam/speaking/synthesise.h"

namespace animeme::tools {

struct OptionTable;

/// Adds --style, --sharpness, --articulate and --symmetric, with the program's defaults: the
/// articulation is that of the model (Model::articulation), and the resting mouth is symmetric.
void add_motion_options(OptionTable& cli, dam::SynthesisOptions& options);

/// Adds --no-tongue, which clears `tongue`.
void add_tongue_option(OptionTable& cli, bool& tongue);

}  // namespace animeme::tools
