/// @file
/// Sound for pages.
#pragma once

#include <string>

#include "tools/app/commands/face_stream.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::tools {

/// The sound of a file, and how long it is.
struct PageSound {
  viewer::Sound sound;  ///< for viewer::Page
  double seconds = 0;   ///< its length
};

/// The sound of a file in an mp4 of its own, as browsers take it. AAC and Opus stay packet by
/// packet as they are, unless `settings` ask for something; anything else is coded, as AAC if
/// nothing is asked for.
Result<PageSound> page_sound(const std::string& path, const SoundSettings& settings);

}  // namespace animeme::tools
