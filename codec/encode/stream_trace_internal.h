// Bit positions of the written syntax elements, and patterns that can mislead other decoders. Not
// installed API. Source: codec/bitstream.md, sections 4 and 17.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace animeme::fba::internal {

/// Bit positions of what was written, from the start of the bytes that go with it.
struct StreamTrace {
  struct Segment {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  std::vector<Segment> segments;         // of the arithmetic coder, those that end in many zeros
  std::vector<std::size_t> start_codes;  // real ones
  std::vector<std::size_t> lost;         // planes that decoders take for stuffing

  void clear() {
    segments.clear();
    start_codes.clear();
    lost.clear();
  }
};

/// Fewer zeros at the end of a segment cannot become a run that decoders take for one of its own.
inline constexpr int kManyZeros = 8;

/// A legal pattern that can mislead another decoder.
struct Hazard {
  enum class Kind : std::uint8_t {
    start_code,  // 23 zeros and a 1 that are no start code
    look_ahead,  // 22 zeros from the tail of a segment into the 14 bits behind it
    lost_plane,  // a plane that lies whole in the byte in front of a start code
  };
  Kind kind = Kind::start_code;
  std::size_t bit = 0;  // the first of the zeros, of the plane
};

/// The hazards in `bytes` by their positions; each place once. Linear in the number of bytes.
std::vector<Hazard> find_hazards(std::span<const std::uint8_t> bytes, const StreamTrace& trace);

}  // namespace animeme::fba::internal
