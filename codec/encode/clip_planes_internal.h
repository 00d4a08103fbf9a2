// A decided clip plane by plane, as an encoder wants it and as a decoder has to give it back. Not
// installed API.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/encode/encoder.h"
#include "codec/encode/plan_internal.h"

namespace animeme::fba::internal {

/// The reconstructed values of one plane at a time. Borrows the clip and the decision.
class ClipPlanes {
 public:
  ClipPlanes(const ClipData& clip, const Decision& decision);

  /// Goes to a plane.
  void load(std::size_t plane);
  const fap::Frame& face() const { return face_; }
  const BodyFrame& body() const { return body_; }
  /// The quantiser of a plane.
  int fap_quant(std::size_t plane) const {
    return decision_.first && plane == 0 ? decision_.first->fap_quant : decision_.fap_quant;
  }

  /// Goes to a plane of `run`. What is returned borrows the run and lasts until the next call.
  PlaneInput input(const Run& run, std::size_t plane);

 private:
  const ClipData& clip_;
  const Decision& decision_;
  fap::Frame face_;
  BodyFrame body_;
};

/// Decodes a stream and compares every coded value with what was to be coded; a difference is
/// Code::internal.
Result<void> verify(const std::vector<std::uint8_t>& stream, const ClipData& clip,
                    const Decision& decision);

}  // namespace animeme::fba::internal
