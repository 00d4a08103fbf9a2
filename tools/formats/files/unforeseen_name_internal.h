// Names of temporary files.
#pragma once

#include <string>

namespace animeme::tools {

/// ".animeme-XXXXXXXXXXXX.part" with letters or digits from the random numbers of the system: who
/// can write to the same folder cannot put a file or a link there first.
std::string unforeseen_name();

}  // namespace animeme::tools
