// Decoded values of the face for those who have no FBA decoder: what `/faps` sends.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "codec/decode/decoder.h"
#include "fap/frame.h"

namespace animeme::web {

/// First message: version, ticks of a second in the small form, and what each FAP is.
std::string values_hello(std::uint32_t timescale);

/// Decodes unit by unit.
class Values {
 public:
  /// The face after this access unit, all of it: FAPs that the plane does not code have the value
  /// that a receiver shows (codec/decode/fill.h); those that are not in the mask are 0. nullopt:
  /// the unit has no face that can be decoded.
  std::optional<fap::Frame> push(std::span<const std::uint8_t> unit);

 private:
  fba::Decoder decoder_;
  bool ahead_ = false;  // the decoder has the first bytes of the next unit already
  fap::Frame shown_;
  fap::Mask sent_;
};

struct ValuesMessage {
  double time = 0, duration = 0;  ///< seconds on the clock of the segments
  bool intra = false;
  std::size_t bytes = 0;  ///< of the access unit
};

/// {"time": .., "duration": .., "intra": .., "bytes": .., "values": {"3": .., ...}}
std::string write_values(const ValuesMessage& message, const fap::Frame& face);

}  // namespace animeme::web
