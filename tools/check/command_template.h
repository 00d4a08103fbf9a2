/// @file
/// A foreign program given as a command line with places for files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// A command line cut into arguments. {in}, {out} and {bap} stand for files, alone or inside an
/// argument; other braces are left alone.
struct CommandTemplate {
  std::vector<std::string> arguments;  ///< program first
  bool names_out = false;              ///< without {out}, standard output is the FAP text
  bool names_bap = false;              ///< {bap} occurs
};

/// Cuts a line at blanks. 'single' and "double" quotes keep blanks together, \ takes the next
/// character as it is (not within single quotes; within double quotes only before " and \).
/// No shell is run: $, *, |, > and the like have no meaning.
/// Errors, invalid_argument: no program, a quote that is not closed, no {in}, or a program that
/// is not found (with a / in its name: that file, else along PATH).
Result<CommandTemplate> parse_command(std::string_view line);

/// The arguments with {in}, {out} and {bap} replaced.
std::vector<std::string> fill_in(const CommandTemplate& command, const std::string& in,
                                 const std::string& out, const std::string& bap);

}  // namespace animeme::tools
