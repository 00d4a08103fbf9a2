// Names of files.
#pragma once

#include <filesystem>
#include <string>

namespace animeme::media {

/// Extension in lower case with its dot: ".mp4"; empty: there is none.
inline std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  }
  return extension;
}

}  // namespace animeme::media
