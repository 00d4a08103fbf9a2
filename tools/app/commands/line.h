/// @file
/// A command line, run.
#pragma once

#include <span>

#include "fap/result.h"
#include "tools/app/commands/options.h"

namespace animeme::tools {

/// The options of the program and of all its commands.
OptionTable program_table();

/// Parses a command line and runs its command; errors were printed. `arguments`: the program first.
/// May be called again and again. Returns the exit code.
int run_line(std::span<const char* const> arguments);

/// Parses the options of the command that runs once more, with its `--settings` file as it is now.
/// `table`: of that command, with variables of its own. Errors: those of settings_words();
/// invalid_argument (a value that the command does not take).
Result<void> parse_again(OptionTable& table);

}  // namespace animeme::tools
