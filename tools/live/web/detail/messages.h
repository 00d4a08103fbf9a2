// The binary messages of /face. Big endian throughout; see protocol.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"

namespace animeme::web {

inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::size_t kUnitHeader = 13;  ///< bytes in front of an access unit
inline constexpr std::size_t kFlagsAt = 12;
inline constexpr std::uint8_t kIntra = 1;   ///< flag: a decoder can begin here
inline constexpr std::uint8_t kMissed = 2;  ///< flag: units in front of this one were dropped

/// First message of /face.
struct Hello {
  std::uint8_t visual_profile = 0;
  bool has_sound = false;            ///< there is /audio
  std::uint32_t timescale = 0;       ///< of face times
  std::vector<std::uint8_t> config;  ///< empty: there is no face

  friend bool operator==(const Hello&, const Hello&) = default;
};

std::vector<std::uint8_t> write_hello(const Hello& hello);
/// Errors: syntax (not our server), unsupported (another version).
Result<Hello> read_hello(std::span<const std::uint8_t> message);

struct UnitMessage {
  std::uint64_t time = 0;  ///< ticks of the timescale
  std::uint32_t duration = 0;
  std::uint8_t flags = 0;
  std::vector<std::uint8_t> bytes;

  friend bool operator==(const UnitMessage&, const UnitMessage&) = default;
};

std::vector<std::uint8_t> write_unit(const UnitMessage& unit);
/// Errors: syntax.
Result<UnitMessage> read_unit(std::span<const std::uint8_t> message);

}  // namespace animeme::web
