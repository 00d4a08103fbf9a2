/// @file
/// JSON as the commands write it: members stay in the order in which they were added.
#pragma once

#include <nlohmann/json.hpp>

namespace animeme::tools {

using Json = nlohmann::ordered_json;

}  // namespace animeme::tools
