/// @file
/// Report on how much a clip moves and where the bits of its stream go.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/text/bap_text.h"
#include "fap/frame.h"
#include "tools/formats/inspect/activity.h"
#include "tools/formats/inspect/bits.h"

namespace animeme::inspect {

/// Statistics of one input.
struct Statistics {
  std::string kind;                   ///< kind of the input
  std::size_t faces = 0;              ///< frames with a face
  std::size_t bodies = 0;             ///< frames with a body
  fap::Rate rate;                     ///< of the face, or else of the body
  double seconds = 0;                 ///< of the stream, else of the face, else of the body
  std::optional<BitStatistics> bits;  ///< streams only
  std::vector<Activity> faps;         ///< those that occur
  std::vector<Activity> baps;         ///< those that occur
};

/// Measures frame by frame, without a whole clip in memory.
class Measurement {
 public:
  void add(const fba::Plane& plane);      ///< of a stream, in order
  void add(const fap::Frame& frame);      ///< of a text
  void add(const fba::BodyFrame& frame);  ///< likewise
  /// `kind`: for the report; `face`, `body`: rates of a text; `bytes`: of a stream, else 0.
  Statistics measured(std::string kind, fap::Rate face, fap::Rate body, std::size_t bytes) const;

 private:
  BitMeter bits_;
  FaceActivity face_;
  BodyActivity body_;
  std::size_t planes_ = 0, faces_ = 0, bodies_ = 0;
  fap::Rate rate_;  // of the first plane
  std::int64_t last_face_ = -1, last_body_ = -1;
};

/// The statistics as JSON text.
std::string statistics_json(const Statistics& statistics);
/// The statistics as text, with a row for each parameter.
std::string statistics_text(const Statistics& statistics);

}  // namespace animeme::inspect
