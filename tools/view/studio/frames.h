/// @file
/// Selects the frames of a clip, or the shapes, to show.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"
#include "fap/viseme.h"

namespace animeme::studio {

/// A frame and its time.
struct ShownFrame {
  fap::Frame frame;    ///< filled
  double seconds = 0;  ///< in the clip
  /// What is said: see head::PoseOptions::visemes.
  std::optional<fap::VisemeWeights> visemes = {};
};

/// The frames shown at these times; `clip` is filled. Errors: out_of_range (a time before the first
/// frame or after the end), not_found (no frames).
Result<std::vector<ShownFrame>> frames_at(const fap::Sequence& clip,
                                          const std::vector<double>& times);

/// Frame `number` of a filled clip. Errors: as above.
Result<std::vector<ShownFrame>> frame_number(const fap::Sequence& clip, std::int64_t number);

/// `count` evenly spaced frames from the first to the last. Errors: not_found (no frames).
Result<std::vector<ShownFrame>> even_frames(const fap::Sequence& clip, int count);

/// Gives frames of a clip what is said in them; `visemes` are by frame of the clip. Frames that are
/// not in it keep what they have.
void say_in(std::vector<ShownFrame>& frames, const fap::Sequence& clip,
            std::span<const fap::VisemeWeights> visemes);

/// The neutral face, then "visemes" 1..14 or "expressions" 1..6 at full strength. Error:
/// invalid_argument (neither of the two words).
Result<std::vector<ShownFrame>> shape_frames(const std::string& what);

}  // namespace animeme::studio
