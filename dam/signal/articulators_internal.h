// Which controls move together, by their names. Internal.
#pragma once

#include <cstdint>
#include <string_view>

namespace animeme::dam {

/// What a control is of. The numbers are those of tables by articulator.
enum class Articulator : std::uint8_t {
  other,    ///< neither a FAP of jaw or mouth nor an ARKit shape of theirs
  jaw,      ///< FAP 3, 14, 15, 18
  lips,     ///< opening of the lips: FAP 4, 5, 8 to 11, 51, 52, 55 to 58
  width,    ///< FAP 6, 7, 53, 54
  corners,  ///< their height: FAP 12, 13, 59, 60
  forward,  ///< FAP 16, 17
};
inline constexpr int kArticulatorCount = 6;  ///< values of Articulator

/// By the name of a FAP channel ("fap6_stretch_l_cornerlip") or an ARKit shape ("mouthStretchLeft",
/// a width).
Articulator articulator_of(std::string_view control);

}  // namespace animeme::dam
