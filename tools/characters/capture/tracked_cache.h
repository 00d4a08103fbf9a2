/// @file
/// A cache of tracking results in a corpus, so that videos are not tracked twice.
#pragma once

#include <optional>
#include <string>

#include "fap/result.h"
#include "tools/characters/capture/read_capture.h"

namespace animeme::tools {

/// A folder, created with the first table, with ID.csv and ID.key; the key names the video, its
/// size and time, and the command.
struct TrackedCache {
  std::string folder;   ///< of all files
  bool forget = false;  ///< find() finds nothing

  /// The table of an unchanged video.
  std::optional<std::string> find(const std::string& id, const std::string& video,
                                  const CaptureSettings& settings) const;
  /// Errors: io.
  Result<void> keep(const std::string& id, const std::string& video,
                    const CaptureSettings& settings, const std::string& table) const;
};

}  // namespace animeme::tools
