// What libavformat leaves to do in a finished mp4 file. Source: tools/media/containers.md, section
// 1.4.
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

/// A whole `moov` box with ES_ID 0 in every `esds`, as 14496-14 wants it in files, with the
/// tracks that have one listed in its `iods`, if there is one (ES_ID_Inc with the track ID), and
/// with a next_track_ID that is free.
std::vector<std::uint8_t> complete_moov(std::span<const std::uint8_t> moov);

/// Adds `shift` to every chunk offset of a whole `moov` box. Error: out_of_range (an offset of 32
/// bits would pass 4 GB).
Result<void> shift_chunks(std::span<std::uint8_t> moov, std::uint64_t shift);

/// Completes the `moov` of a file. If media data lies before it and `contents_first` is set, it
/// is moved to the front. Works in place. Errors: io, out_of_range, internal (no moov box).
Result<void> complete_mp4(const std::string& path, bool contents_first);

}  // namespace animeme::media
