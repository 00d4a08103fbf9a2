/// @file
/// Converts received planes to FAP frames, also for text output.
///
///     LiveFrames frames(GapRule::hold, fap::FillOptions{.keep_high_level = true});
///     if (auto unit = recorder.accept(event); unit && unit->track == LiveTrack::face) {
///       auto shown = frames.push(*unit, recorder.info()->timescale, recorder.after_gap());
///       for (const fap::Frame& frame : *shown) fap::append_text(text, frame);
///     }
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "fap/frame.h"
#include "fap/receiver.h"
#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// Output while planes are missing.
enum class GapRule : std::uint8_t {
  hold,     ///< repeat the last values
  neutral,  ///< blend to the neutral face within 0.4 s
  skip,     ///< no frames: the frame numbers have a gap
};

/// Decodes planes one by one and numbers the frames by their times, from 0.
class LiveFrames {
 public:
  /// With `shown`, frames have the values that a receiver shows (fap/receiver.h), masks accumulate,
  /// and there is a frame for each number (unless GapRule::skip omits some). Without it they are as
  /// coded, and frames that the sender omitted are missing.
  LiveFrames(GapRule gap, const std::optional<fap::FillOptions>& shown) : gap_(gap) {
    if (shown) receiver_.emplace(*shown);
  }

  /// The frames that a plane adds: those of the gap before it, if planes are missing, and its own;
  /// none if it has no face. Planes must begin with an intra plane and continue with one after a
  /// gap. A plane that cannot be decoded gives no frame, nor do those after it up to the next intra
  /// plane.
  std::vector<fap::Frame> push(const LiveUnit& unit, std::uint32_t timescale, bool after_gap);
  /// Rate of the last plane that was decoded.
  fap::Rate rate() const { return rate_; }

 private:
  std::optional<fba::Plane> decode(const LiveUnit& unit);
  void add_gap(std::int64_t end, bool lost, std::vector<fap::Frame>& frames) const;
  fap::Frame shown(const fba::Plane& plane, const fap::Frame& frame);

  GapRule gap_;
  std::optional<fap::Receiver> receiver_;
  fba::Decoder decoder_;
  std::int64_t pushed_ = 0, delivered_ = 0;  // planes, by and to the decoder
  bool damaged_ = false;                     // planes could not be decoded since the last frame
  fap::Rate rate_;
  std::optional<std::int64_t> first_time_;
  std::optional<fap::Frame> last_;
};

}  // namespace animeme::media
