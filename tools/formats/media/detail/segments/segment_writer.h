// Face and sound as segments for HLS or DASH. Source: tools/formats/media/containers.md,
// sections 2.2 and 4.3.
#pragma once

#include <string>

#include "tools/formats/media/mux.h"

namespace animeme::media {

/// Writes `path`, which ends in .m3u8 or .mpd, and the folder of segments beside it: "talk_hls"
/// for talk.m3u8, "talk_dash" for talk.mpd. The input has been checked. Errors: as
/// write_container().
Result<MuxResult> write_segments(const std::string& path, const MuxInput& input,
                                 const MuxOptions& options);

}  // namespace animeme::media
