/// @file
/// Statistics of heads as JSON.
#pragma once

#include "tools/formats/common/json.h"
#include "tools/live/serve/head.h"

namespace animeme::serve {

/// Of one head.
tools::Json head_json(const HeadFigures& figures);

/// A histogram named animeme_NAME in the text format of Prometheus.
std::string histogram(const std::string& name, const std::string& help,
                      const media::LatenessMeter& meter);

}  // namespace animeme::serve
