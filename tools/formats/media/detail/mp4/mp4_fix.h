// What libavformat leaves to do in a finished mp4 file. Source: tools/formats/media/containers.md,
// section 1.4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/detail/mp4/metadata_tracks.h"

namespace animeme::media {

/// Offsets, in a whole `moov` box, of the two ES_ID bytes of every `esds` of its tracks.
/// Walks boxes and descriptors; nothing is searched for. Broken boxes are passed over.
std::vector<std::size_t> find_es_ids(std::span<const std::uint8_t> moov);

/// A whole `moov` box with ES_ID 0 in every `esds`, as 14496-14 wants it in files, with the
/// tracks that have one listed in its `iods`, if there is one (ES_ID_Inc with the track ID), with
/// texts that are not enabled, with a next_track_ID that is free, with faces and texts as `types`
/// says, and with the `duration` of fragments, if given (mehd, in the time scale of the movie).
std::vector<std::uint8_t> complete_moov(std::span<const std::uint8_t> moov, const TrackTypes& types,
                                        std::optional<std::uint64_t> duration = {});

/// Adds `shift` to every chunk offset of a whole `moov` box. Error: out_of_range (an offset of 32
/// bits would pass 4 GB).
Result<void> shift_chunks(std::span<std::uint8_t> moov, std::uint64_t shift);

/// What a file is to look like.
enum class Layout : std::uint8_t {
  as_written,      ///< contents stay where they are
  contents_first,  ///< moved in front of the media data
  indexed,         ///< the same; fragments have their duration and an index in front of them
};

/// Completes the `moov` of a file. Works in place. Errors: io, out_of_range, internal (no moov
/// box).
Result<void> complete_mp4(const std::string& path, Layout layout, const TrackTypes& types);

}  // namespace animeme::media
