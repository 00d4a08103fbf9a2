/// @file
/// The sound of a page, as browsers take it.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/commands/face_stream.h"
#include "tools/viewer/viewer.h"

namespace animeme::tools {

/// The sound of a page.
struct PageSound {
  viewer::Sound sound;  ///< ready to be packed in
  double seconds = 0;   ///< its length
};

/// The sound of a file in an mp4 of its own. AAC and Opus stay packet by packet as they are, unless
/// `settings` ask for something; anything else is coded, as AAC if nothing is asked for. Errors:
/// those of read_coded_sound() and media::write_mp4().
Result<PageSound> page_sound(const std::string& path, const SoundSettings& settings);

}  // namespace animeme::tools
