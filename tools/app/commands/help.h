/// @file
/// Help, man pages and completions of shells, from the tables of options.
#pragma once

#include <string>

#include "tools/app/commands/options.h"

namespace animeme::tools {

/// What --help prints of a command, or of the program. `all`: also what only --help-all shows.
/// Lines are at most `width` characters wide, as far as words allow.
std::string help_text(const OptionTable& table, const OptionTable& program, bool all, int width);

/// A page for man(7), of the program or of one of its commands, as `animeme-NAME`. `version`:
/// "0.1.0".
std::string man_page(const OptionTable& table, const OptionTable& program,
                     const std::string& version);

/// A script that completes commands, options and their values: for "bash", "zsh" or "fish".
std::string completion(const OptionTable& program, const std::string& shell);

}  // namespace animeme::tools
