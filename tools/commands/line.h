/// @file
/// A command line, run.
#pragma once

#include <span>

namespace animeme::tools {

/// Parses a command line and runs its command; errors were printed. `arguments`: the program first.
/// May be called again and again. Returns the exit code.
int run_line(std::span<const char* const> arguments);

}  // namespace animeme::tools
