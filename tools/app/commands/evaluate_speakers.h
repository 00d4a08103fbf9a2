/// @file
/// evaluate --speakers: training for strangers.
#pragma once

#include "tools/app/commands/evaluate_options.h"

namespace animeme::tools {

/// Warps options.speakers into other speakers, compares systems on them and prints the table.
Result<int> run_speakers(const EvaluateOptions& options);

}  // namespace animeme::tools
