// An address and the options behind it.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::webrtc {

struct Where {
  std::string address;  ///< up to the '?'
  WebRtcOptions options;
};

/// Errors: invalid_argument (an option that does not exist, or its value).
Result<Where> parse_where(const std::string& url);

}  // namespace animeme::webrtc
