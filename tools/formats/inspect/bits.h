/// @file
/// Statistics on where the bits of a stream go.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "codec/decode/decoder.h"

namespace animeme::inspect {

/// Sizes of the planes of one type, in bits. All 0 if there are none.
struct PlaneBits {
  std::size_t planes = 0;    ///< of this type
  double mean = 0;           ///< bits a plane
  double median = 0;         ///< bits a plane
  std::int64_t largest = 0;  ///< bits
};

/// Where the bits of a stream went.
struct BitStatistics {
  double seconds = 0;          ///< from the first plane to the end of the last
  double kbit_per_s = 0;       ///< the whole stream
  double peak_kbit_per_s = 0;  ///< the largest second (shorter streams: everything)
  PlaneBits intra;             ///< intra planes
  PlaneBits predictive;        ///< predicted planes

  // Every bit of the stream is one of these three kinds.
  std::int64_t framing_bits = 0;  ///< start codes, stuffing, sequence headers
  std::int64_t header_bits = 0;   ///< types, temporal headers, masks, quantisers, ranges
  std::int64_t value_bits = 0;    ///< segments, and flags of FAP 1 and 2

  /// Ideal cost of each parameter: -log2 of its probability in the adaptive models, summed over the
  /// stream, without segment ends and stuffed bits.
  std::array<double, fap::kFapCount + 1> ideal_fap_bits{};
  std::array<double, fba::kBapCount + 1> ideal_bap_bits{};  ///< by BAP number

  double ideal_bits() const;  ///< sum of both
};

/// Exact number of bits of a plane's header, everything before its segments.
std::int64_t header_bits(const fba::Plane& plane);

/// Counts plane by plane. Memory: 4 bytes a plane, and the planes of one second.
class BitMeter {
 public:
  BitMeter();
  ~BitMeter();
  void add(const fba::Plane& plane);  ///< in stream order
  /// `bytes`: the size of the stream. Requires at least one plane.
  BitStatistics measured(std::size_t bytes) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::inspect
