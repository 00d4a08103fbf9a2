/// @file
/// FAP frames out of planes as they are received, and as text.
///
///     LiveFrames frames(GapRule::hold, true);
///     if (auto unit = recorder.accept(event); unit && unit->track == LiveTrack::face) {
///       auto shown = frames.push(*unit, recorder.info()->timescale, recorder.after_gap());
///       for (const fap::Frame& frame : *shown) text += fap_lines(frame, frames.rate());
///     }
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "fap/frame.h"
#include "tools/media/live/live.h"

namespace animeme::media {

/// What is shown while planes are missing.
enum class GapRule : std::uint8_t {
  hold,     ///< the last values
  neutral,  ///< they ease to the neutral face within 0.4 s
  skip,     ///< nothing: the frame numbers have a gap
};

/// Decodes planes one by one and numbers the frames by their times, from 0 on. Frames that the
/// sender left out stay out.
class LiveFrames {
 public:
  /// `fill`: every FAP in every frame, see fba/fill.h.
  LiveFrames(GapRule gap, bool fill) : gap_(gap), fill_(fill) {}

  /// The frames that a plane adds: those of the gap before it, if planes are missing there, and its
  /// own; none if it has no face. Planes must begin with an intra plane and, behind a gap, go on
  /// with one. A plane that cannot be decoded gives no frame, nor do those up to the next intra
  /// plane. Errors: those of fap::fill().
  Result<std::vector<fap::Frame>> push(const LiveUnit& unit, std::uint32_t timescale,
                                       bool after_gap);
  /// Rate of the last plane that was decoded.
  fap::Rate rate() const { return rate_; }

 private:
  std::optional<fba::Plane> decode(const LiveUnit& unit);
  void add_gap(std::int64_t end, std::vector<fap::Frame>& frames) const;
  Result<fap::Frame> filled(const fba::Plane& plane, fap::Frame frame) const;

  GapRule gap_;
  bool fill_;
  fba::Decoder decoder_;
  std::int64_t pushed_ = 0, delivered_ = 0;  // planes, by and to the decoder
  bool damaged_ = false;                     // planes could not be decoded since the last frame
  fap::Rate rate_;
  std::optional<std::int64_t> first_time_;
  std::optional<fap::Frame> last_;
};

/// FAP text by the frame: its first line, which cannot know their number and says 0, and the two
/// lines of a frame.
std::string fap_header(fap::Rate rate, const std::string& name);
std::string fap_lines(const fap::Frame& frame, fap::Rate rate);  ///< `frame` is numbered at `rate`

}  // namespace animeme::media
