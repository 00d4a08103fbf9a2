// Names of files.
#pragma once

#include <filesystem>
#include <string>

#include "tools/formats/media/detail/tracks/words_internal.h"

namespace animeme::media {

/// Extension in lower case with its dot: ".mp4"; empty: there is none.
inline std::string extension_of(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

}  // namespace animeme::media
