/// @file
/// How heads are doing, as JSON.
#pragma once

#include "tools/json.h"
#include "tools/serve/head.h"

namespace animeme::serve {

/// Of one head.
tools::Json head_json(const HeadFigures& figures);

}  // namespace animeme::serve
