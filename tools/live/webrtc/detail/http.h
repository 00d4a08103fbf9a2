// A request of HTTP by libcurl. Part of the module.
#pragma once

#include "tools/live/webrtc/detail/peer.h"

namespace animeme::webrtc {

/// See Functions::exchange.
HttpAnswer exchange(const HttpRequest& request);

}  // namespace animeme::webrtc
