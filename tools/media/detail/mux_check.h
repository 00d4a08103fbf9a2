// What must hold before anything is written.
#pragma once

#include "tools/media/mux.h"

namespace animeme::media {

/// Errors: those of write_container() for its input and options.
Result<void> check_input(const MuxInput& input, const MuxOptions& options);

}  // namespace animeme::media
