/// @file
/// Options that name files to be written: which endings fit, and that nothing that is read is
/// written over.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/app/commands/options.h"

namespace animeme::tools {

/// The extensions of a raw FBA stream: ours, and what other programs call elementary streams.
inline constexpr const char* kStreamEndings = ".fba .bit .bits .bin .es";

/// What is wrong with the outputs that were given, as a sentence; empty: nothing. Wrong is an
/// ending that does not fit, a file that another option of the command reads or writes (by whatever
/// name or link), and a folder of HLS or DASH segments that would replace one in which an input
/// lies.
std::string problem_with_outputs(const OptionTable& command);

/// Whether all outputs that were given can be written: their folders are there, writable and not
/// full, their names are not those of folders. Asked before the work is begun; nothing stays
/// behind. Errors: io, with the output.
Result<void> outputs_can_be_written(const OptionTable& command);

/// For files that a command writes beside its output: a sentence if an option of the command that
/// problem_with_outputs() was called for reads this file; else empty.
std::string problem_with_another_output(const std::string& path);

}  // namespace animeme::tools
