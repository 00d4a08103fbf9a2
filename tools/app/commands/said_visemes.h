/// @file
/// What a face says, for heads that have a shape for each viseme (head::PoseOptions::visemes).
#pragma once

#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/frame.h"
#include "fap/viseme.h"
#include "tools/app/commands/common.h"

namespace animeme::tools {

struct OptionTable;

/// The values of --mouth.
inline constexpr const char* kMouthByVisemes = "visemes";
inline constexpr const char* kMouthByFaps = "faps";  ///< see kMouthByVisemes

/// Adds --mouth: `mouth` is one of these two.
void add_mouth_option(OptionTable& cli, std::string& mouth);

/// One for each frame of `shown`, the face of `input` as shown_face() gives it: by the phones of
/// `script` (on the clock of FaceInput::start), else by FAP 1 where frames carry it. Empty: neither
/// is known, FAP 1 has a shape that the stream defines, or `mouth` is kMouthByFaps.
std::vector<fap::VisemeWeights> said_visemes(const FaceInput& input, const fap::Sequence& shown,
                                             const dam::Script& script, const std::string& mouth);

}  // namespace animeme::tools
