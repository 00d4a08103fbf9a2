// Access units of a live stream, decoded one by one. Not installed API.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "codec/decode/decoder.h"
#include "codec/syntax/plane.h"

namespace animeme::fba::internal {

inline constexpr std::array<std::uint8_t, 3> kCodePrefix = {0, 0, 1};  // of any start code

inline bool begins_with_code(std::span<const std::uint8_t> bytes) {
  return bytes.size() > kCodePrefix.size() &&
         std::equal(kCodePrefix.begin(), kCodePrefix.end(), bytes.begin());
}

inline bool begins_object(std::span<const std::uint8_t> bytes) {
  return begins_with_code(bytes) &&
         is_object_start((kPlaneStart & ~0xFFU) | bytes[kCodePrefix.size()]);
}

/// The unit of a splicer that begins here: an object start code stands before its plane.
inline std::span<const std::uint8_t> without_object(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kCodeAndStuffing = 5;
  const bool object = begins_object(bytes);
  return object && bytes.size() > kCodeAndStuffing ? bytes.subspan(kCodeAndStuffing) : bytes;
}

/// A decoder wants to see what stands behind a plane; all units begin with a start code.
class UnitDecoder {
 public:
  /// The plane of the next unit; false: it cannot be decoded.
  bool decode(std::span<const std::uint8_t> unit, Plane& plane) {
    if (!begins_with_code(unit)) return false;
    decoder_.push(ahead_ ? unit.subspan(kCodePrefix.size()) : unit);
    decoder_.push(kCodePrefix);
    ahead_ = true;
    bool found = false;
    for (;;) {
      Result<Event> event = decoder_.next();
      if (event && event->kind == Event::Kind::plane) {
        plane = std::move(event->plane);
        found = true;
      }
      if (event) continue;
      if (event.error().code == Code::need_data) return found;
      found = false;
      if (event.error().code == Code::end_of_stream) return false;
    }
  }

 private:
  Decoder decoder_;
  bool ahead_ = false;  // the prefix of the next unit was pushed
};

}  // namespace animeme::fba::internal
