/// @file
/// FAPs as people name them on the command line.
#pragma once

#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// Numbers 3..68 of FAPs given by number, name ("open_jaw") or range ("3-13"), as they come. Error:
/// invalid_argument, which names the first that is none of these.
Result<std::vector<int>> fap_numbers(const std::vector<std::string>& names);

}  // namespace animeme::tools
