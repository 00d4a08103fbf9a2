// Segments in a folder, put together again: what a playlist on this machine refers to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

/// Is a file with this name a playlist (.m3u8) or a DASH description (.mpd)?
bool is_playlist(const std::string& path);

struct Presentation {
  const char* format = "hls";                         ///< or "dash"
  std::vector<std::vector<std::uint8_t>> renditions;  ///< each: initialization and segments
};

/// Reads the playlist and all that it refers to. A closed room: only ordinary files in the folder
/// of the playlist or below it are opened, whatever names or symbolic links say, and not more than
/// 1 GB in all. Errors: not_found, io, syntax, truncated, unsupported, out_of_range.
Result<Presentation> read_presentation(const std::string& path);

/// A file name as a relative reference: other characters than letters, digits and -_.~/ as %XX.
std::string to_reference(const std::string& name);

/// Back again. Errors: syntax (damaged %XX), unsupported (an address, an absolute name, or one
/// that leads out of the folder).
Result<std::string> from_reference(const std::string& reference);

}  // namespace animeme::media
