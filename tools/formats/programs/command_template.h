/// @file
/// A program of others given as a command line with places for files.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// A command line cut into arguments. A name in braces, as {in}, stands for a file or a text, alone
/// or inside an argument.
struct CommandTemplate {
  std::vector<std::string> arguments;  ///< program first

  bool names(std::string_view place) const;  ///< whether {place} occurs
};

/// What stands for {name}.
struct Place {
  std::string_view name;  ///< without braces
  std::string_view text;  ///< taken as it is: braces in it stay
};

/// The arguments of a line, as parse_command() cuts it. Errors, invalid_argument: a quote that is
/// not closed.
Result<std::vector<std::string>> split_arguments(std::string_view line);

/// Cuts a line at blanks. 'single' and "double" quotes keep blanks together, \ takes the next
/// character as it is (not within single quotes; within double quotes only before " and \).
/// No shell is run: $, *, |, > and the like have no meaning.
/// Errors, invalid_argument: no program, a quote that is not closed, or a program that is not found
/// (with a / in its name: that file, else along PATH).
Result<CommandTemplate> parse_command(std::string_view line);

/// The arguments with the places replaced; other braces are left alone.
std::vector<std::string> fill_in(const CommandTemplate& command, std::span<const Place> places);

}  // namespace animeme::tools
