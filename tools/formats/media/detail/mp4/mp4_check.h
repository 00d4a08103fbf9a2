// A look at an mp4 before libavformat gets it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/detail/mp4/metadata_tracks.h"

namespace animeme::media {

/// Reads `buffer.size()` bytes at an offset; false: not there.
using ReadAt = std::function<bool(std::uint64_t offset, std::span<std::uint8_t> buffer)>;

/// Refuses a fragmented mp4 with a track that has no track header or no number: libavformat 5.1
/// then keeps an error code as a fragment number and counts up from it, a thousand million steps
/// for each run of samples. Other files pass, whatever they are. Gives the tracks of timed
/// metadata that libavformat does not look into. Error: syntax.
Result<std::vector<MetadataTrack>> look_at_mp4(std::uint64_t size, const ReadAt& read);

}  // namespace animeme::media
