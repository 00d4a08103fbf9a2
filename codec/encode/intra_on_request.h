/// @file
/// Intra planes for receivers that ask for them, in a stream that somebody else codes.
///
///     animeme::fba::IntraOnRequest face;
///     const auto recoded = face.pass(unit.bytes, receiver_has_asked);
///     send(recoded ? recoded->bytes : unit.bytes);
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace animeme::fba {

/// An access unit to send in place of that of the source.
struct RecodedUnit {
  std::vector<std::uint8_t> bytes;  ///< as AccessUnit::bytes
  bool intra = false;               ///< a receiver can start here
};

/// Follows the access units of a stream. Where an intra plane is asked for, the next unit becomes
/// one that holds everything, and the units up to the next intra plane of the source are coded
/// again with the same values (splice.h). All other units stay as they are. Movable, not copyable.
class IntraOnRequest {
 public:
  IntraOnRequest();                           ///< before the first unit
  IntraOnRequest(IntraOnRequest&&) noexcept;  ///< movable
  IntraOnRequest& operator=(IntraOnRequest&&) noexcept;
  ~IntraOnRequest();

  /// The next unit of the source; `wanted`: as an intra plane. nullopt: it is sent as it is. So is
  /// a unit that cannot be decoded, and so are those behind it up to the next intra plane.
  std::optional<RecodedUnit> pass(std::span<const std::uint8_t> unit, bool wanted);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fba
