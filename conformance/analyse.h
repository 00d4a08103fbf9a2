/// @file
/// The features that a stream exercises, found by decoding and re-encoding it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "conformance/stream_writer.h"

namespace animeme::conformance {

/// The planes of a decoded stream as levels, ready for StreamWriter.
std::vector<PlaneSpec> plane_specs(std::span<const std::uint8_t> bytes,
                                   const fba::DecodedStream& decoded);

/// Facts about a stream that can be decoded.
struct StreamFacts {
  std::vector<std::string> features;    ///< ids of features.h, in their order
  int planes = 0,                       ///< all
      intra_planes = 0,                 ///< with settings
      face_planes = 0,                  ///< with face data
      body_planes = 0;                  ///< with body data
  int largest_alphabet = 0;             ///< symbols of the largest model that was used
  std::int64_t largest_plane_bits = 0;  ///< header included, start code not
  /// The second writer gives the same bits for all planes; else where they differ first.
  bool same_when_rewritten = false;
  std::int64_t first_difference_bit = -1;  ///< bit position in the stream; -1: none
  /// First plane that looks like the end of the object, see stream_writer.h; -1: none.
  std::int64_t ambiguous_bit = -1;
};
/// Decodes nothing itself: `decoded` is what the codec made of `bytes`.
StreamFacts analyse(std::span<const std::uint8_t> bytes, const fba::DecodedStream& decoded);

}  // namespace animeme::conformance
