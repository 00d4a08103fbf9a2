/// @file
/// What motion holds, as JSON and as text: clips, bodies, streams and their planes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
#include "fap/frame.h"
#include "tools/formats/common/json.h"

namespace animeme::inspect {

/// Frames, rate, and the range of values of each parameter.
tools::Json describe_clip(const fap::Sequence& clip);
tools::Json describe_body(const fba::BodySequence& body);  ///< the same of a body

/// How many frames there are, and what parameters they have from where to where. Frame: that of a
/// face or of a body.
template <class Frame>
struct Extent {
  struct Range {
    std::int32_t low = 0, high = 0;
  };
  std::size_t frames = 0;
  std::int64_t last = -1;      ///< number of the last frame
  decltype(Frame::mask) used;  ///< parameters that occur
  std::vector<Range> range = std::vector<Range>(decltype(Frame::mask)().size());  ///< by number

  void add(const Frame& frame);
};

/// describe_clip() of frames that were added one by one.
tools::Json describe_clip(const Extent<fap::Frame>& clip, fap::Rate rate);

/// A stream, plane by plane; without what each of them says.
struct StreamExtent {
  std::size_t planes = 0, intra = 0;
  std::int64_t last = -1;                   ///< number of the last plane
  fap::Rate rate;                           ///< of the first plane
  std::optional<int> fap_quant, bap_quant;  ///< the first ones
  Extent<fap::Frame> face;
  Extent<fba::BodyFrame> body;

  void add(const fba::Plane& plane);
};

/// One plane at least was added. `bytes`: the size of the stream.
tools::Json describe_stream(const StreamExtent& stream, const fba::StreamInfo& info,
                            const std::vector<std::string>& warnings, std::size_t bytes);

/// All that a plane says but its values. Ranges are in levels at quantiser 1, in the order of the
/// parameters named.
tools::Json describe_plane(const fba::Plane& plane);

/// The same as a line of a table, with its heading. Ranges are the widest of all parameters.
std::string planes_heading();
std::string plane_text(const fba::Plane& plane);

}  // namespace animeme::inspect
