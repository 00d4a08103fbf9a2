/// @file
/// What `animeme render` shows: which frames of a clip, and where their pictures go.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"
#include "tools/render/image.h"

namespace animeme::tools {

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

/// The neutral face, then "visemes" 1..14 or "expressions" 1..6 at full strength.
Result<std::vector<ShownFrame>> shape_frames(const std::string& what);

/// Takes pictures one after the other.
class PictureSink {
 public:
  virtual ~PictureSink() = default;
  virtual Result<void> add(const render::Image& image) = 0;  ///< takes one picture
  /// Once, after the last one.
  virtual Result<void> finish() = 0;
};

/// One PNG file of all pictures in rows of `columns`; "-" is standard output. The file is written
/// by finish().
std::unique_ptr<PictureSink> png_sink(const std::string& path, int columns);

}  // namespace animeme::tools
