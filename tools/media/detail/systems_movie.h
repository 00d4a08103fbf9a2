// A complete MPEG-4 Systems presentation, which libavformat cannot write. Source:
// tools/media/containers.md, section 1.5.
#pragma once

#include "codec/decode/access_unit.h"
#include "tools/media/detail/mp4_file.h"
#include "tools/media/encoded_audio.h"

namespace animeme::media {

/// Scene, object, face and sound tracks. `sound` is AAC or nullptr: none.
Mp4Movie systems_movie(const fba::AccessUnits& face, const EncodedAudio* sound, int visual_profile);

}  // namespace animeme::media
