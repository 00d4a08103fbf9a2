/// @file
/// A command line with placeholders for files.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// A command line split into arguments. A name in braces, such as {in}, is a placeholder for a file
/// or a text, alone or inside an argument.
struct CommandTemplate {
  std::vector<std::string> arguments;  ///< program first

  bool names(std::string_view place) const;  ///< whether {place} occurs
};

/// The value of a placeholder {name}.
struct Place {
  std::string_view name;  ///< without braces
  std::string_view text;  ///< literal: braces in it are kept
};

/// Splits a line into arguments, as parse_command() does. Errors: invalid_argument (an unclosed
/// quote).
Result<std::vector<std::string>> split_arguments(std::string_view line);

/// Splits a line at blanks. 'single' and "double" quotes protect blanks, \ quotes the next
/// character (not within single quotes; within double quotes only before " and \). There is no
/// shell: $, *, |, > etc. have no meaning. Errors: invalid_argument (no program, an unclosed quote,
/// or a program that is not found: that file if its name has a /, else in PATH).
Result<CommandTemplate> parse_command(std::string_view line);

/// A path as the value of a placeholder: one that begins with "-" gets "./" before it.
std::string path_argument(std::string path);

/// The arguments with placeholders replaced; other braces are unchanged. A text that begins with
/// "-" would be an option of the program, which the author of the text would choose, not that of
/// the command: it is refused where a placeholder begins an argument, unless an argument "--" is
/// before it. Errors: invalid_argument.
Result<std::vector<std::string>> fill_in(const CommandTemplate& command,
                                         std::span<const Place> places);

}  // namespace animeme::tools
