/// @file
/// FAPs as people name them on the command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// The number of a low-level FAP, 3..68, that a text is; 0 if it is none.
int fap_number(std::string_view text);

/// Numbers 3..68 of FAPs given by number, name ("open_jaw") or range ("3-13"), as they come. Error:
/// invalid_argument, which names the first that is none of these.
Result<std::vector<int>> fap_numbers(const std::vector<std::string>& names);

/// Those of one text, for read_by().
Result<std::vector<int>> faps_of(const std::string& name);

}  // namespace animeme::tools
