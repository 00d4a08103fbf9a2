/// @file
/// JSON as the commands write it: members stay in the order in which they were added.
#pragma once

#include <nlohmann/json.hpp>

namespace animeme::tools {

/// Ordered: a script sees members as they were added.
using Json = nlohmann::ordered_json;

}  // namespace animeme::tools
