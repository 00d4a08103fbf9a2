// FAPs as people name them on the command line.
#pragma once

#include <string>
#include <vector>

namespace animeme::tools {

/// Numbers 3..68 of FAPs given by number or name ("open_jaw"). A 0 at the end: the last one taken
/// is not known; the rest is left out.
std::vector<int> fap_numbers(const std::vector<std::string>& names);

}  // namespace animeme::tools
