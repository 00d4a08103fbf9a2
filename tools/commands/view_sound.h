// The sound of a page, as browsers take it.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/viewer/viewer.h"

namespace animeme::tools {

/// The sound of a file in an mp4 of its own: AAC and Opus packet by packet as they are, anything
/// else coded as AAC. Errors: those of media::read_encoded_audio(), read_audio(), encode_audio()
/// and write_mp4(); not_found: no file, or no sound in it.
Result<viewer::Sound> page_sound(const std::string& path);

}  // namespace animeme::tools
