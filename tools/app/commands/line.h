/// @file
/// A command line, run.
#pragma once

#include <span>

namespace CLI {
class App;
}

namespace animeme::tools {

/// The program with all its commands, for those who read their options.
void set_up_program(CLI::App& app);

/// Parses a command line and runs its command; errors were printed. `arguments`: the program first.
/// May be called again and again. Returns the exit code.
int run_line(std::span<const char* const> arguments);

}  // namespace animeme::tools
