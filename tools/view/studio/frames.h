/// @file
/// Which frames of a clip to show, and which shapes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::studio {

/// A frame and when it is shown.
struct ShownFrame {
  fap::Frame frame;    ///< filled
  double seconds = 0;  ///< in the clip
};

/// The frames at these times (the last one that has begun); `clip` is filled. Errors: out_of_range
/// (a time before the first frame or behind the end), not_found (no frames).
Result<std::vector<ShownFrame>> frames_at(const fap::Sequence& clip,
                                          const std::vector<double>& times);

/// Frame `number` of a filled clip. Errors: as above.
Result<std::vector<ShownFrame>> frame_number(const fap::Sequence& clip, std::int64_t number);

/// `count` frames, evenly from the first to the last. Errors: not_found (no frames).
Result<std::vector<ShownFrame>> even_frames(const fap::Sequence& clip, int count);

/// The neutral face, then "visemes" 1..14 or "expressions" 1..6 at full strength. Error:
/// invalid_argument (neither of the two words).
Result<std::vector<ShownFrame>> shape_frames(const std::string& what);

}  // namespace animeme::studio
