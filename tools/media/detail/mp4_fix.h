// What libavformat leaves to do in a finished mp4 file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

/// Offsets, in a whole `moov` box, of the two ES_ID bytes of every `esds` of its tracks.
/// Walks boxes and descriptors; nothing is searched for. Broken boxes are passed over.
std::vector<std::size_t> find_es_ids(std::span<const std::uint8_t> moov);

/// Sets ES_ID to 0 in every `esds`, as 14496-14 wants it in files (source: containers, 1.4).
/// Errors: io, internal (no moov box).
Result<void> clear_es_ids(const std::string& path);

}  // namespace animeme::media
