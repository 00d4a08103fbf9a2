// The module, loaded once a process.
#pragma once

#include "fap/result.h"
#include "tools/live/webrtc/detail/peer.h"

namespace animeme::webrtc {

/// Its functions, ready. Errors: as load().
Result<const Functions*> functions();

}  // namespace animeme::webrtc
