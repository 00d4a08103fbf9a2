// Several planes in one PES packet: where one ends and the next begins. Borders are parsed, never
// searched for. Source: tools/formats/media/containers.md, sections 1.3 and 3.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"

namespace animeme::media {

class PlaneCutter {
 public:
  struct Piece {
    std::size_t size = 0;
    double seconds = 0;  ///< from the first piece, as the planes tell
  };
  /// What a packet holds behind the configuration, packets in their order; `intra`: it begins with
  /// an intra plane. One piece: it is one plane, or its borders are unknown.
  std::vector<Piece> cut(std::span<const std::uint8_t> packet, bool intra);
  /// Data is missing here: borders are unknown up to the next intra plane.
  void gap() { following_ = false; }

 private:
  bool parse(std::vector<Piece>& pieces, std::int64_t begin, std::size_t size);

  fba::Decoder decoder_;
  std::int64_t fed_ = 0;  // bytes, without the start code ahead
  bool following_ = false;
};

/// Units joined as long as they begin within `seconds` of the first one and a PlaneCutter takes
/// them apart again, times included. Intra planes begin a packet.
fba::AccessUnits share_packets(const fba::AccessUnits& face, double seconds);

}  // namespace animeme::media
