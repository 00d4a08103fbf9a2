/// @file
/// Statistics of heads as JSON.
#pragma once

#include "tools/formats/common/json.h"
#include "tools/live/serve/head.h"

namespace animeme::serve {

/// Of one head.
tools::Json head_json(const HeadFigures& figures);

}  // namespace animeme::serve
