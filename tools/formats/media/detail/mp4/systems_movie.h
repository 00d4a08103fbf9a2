// A complete MPEG-4 Systems presentation, which libavformat cannot write. Source:
// tools/formats/media/containers.md, section 1.5.
#pragma once

#include "codec/decode/access_unit.h"
#include "tools/formats/media/detail/mp4/mp4_file.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

/// Scene, object, face and sound tracks. `sound` is AAC or nullptr: none.
Mp4Movie systems_movie(const fba::AccessUnits& face, const EncodedAudio* sound, int visual_profile);

}  // namespace animeme::media
