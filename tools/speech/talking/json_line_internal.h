// A line of JSON.
#pragma once

#include <string_view>

#include "fap/result.h"
#include "tools/formats/common/json.h"

namespace animeme::speech {

/// A JSON object, nested at most 64 deep. Errors: syntax, out_of_range (deeper).
Result<tools::Json> parse_object(std::string_view text);

}  // namespace animeme::speech
