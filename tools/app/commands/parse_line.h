/// @file
/// Command lines, parsed by the tables of options.
#pragma once

#include <span>
#include <string>

#include "tools/app/commands/options.h"

namespace animeme::tools {

/// What a command line asks for.
struct ParsedLine {
  /// What is to be done.
  enum class Action : unsigned char { run, help, help_all, version, fail };
  Action action = Action::run;  ///< for the command or the program
  std::string problem;          ///< a sentence, if the line is wrong
};

/// Parses the words behind the program's name, sets the variables of the options that were given,
/// and their Option::values. `command`: the one that the line names; nullptr: none. Options of
/// `program` may stand before and behind the command.
ParsedLine parse_line(OptionTable& program, OptionTable* command,
                      std::span<const char* const> words);

}  // namespace animeme::tools
