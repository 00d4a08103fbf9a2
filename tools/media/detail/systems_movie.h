// A complete MPEG-4 Systems presentation, which libavformat cannot write. Source: containers,
// section 1.5.
#pragma once

#include "tools/media/detail/mp4_file.h"
#include "tools/media/mux.h"

namespace animeme::media {

/// Scene, object, face and sound tracks. `sound` may be nullptr; its rate must be one of AAC.
/// Errors: those of the encoder.
Result<Mp4Movie> systems_movie(const fba::AccessUnits& face, const Pcm* sound, int visual_profile,
                               const MuxOptions& options);

}  // namespace animeme::media
