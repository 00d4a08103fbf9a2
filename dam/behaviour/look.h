/// @file
/// Where a face looks.
///
///     camera            at the viewer, straight ahead
///     away              past the viewer, here and there
///     20,-5             degrees: 20 to the person's left, 5 down
///     0.3,-0.1,0.8      a point in metres from between the eyes: to the person's left, up, ahead
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "fap/result.h"

namespace animeme::dam {

inline constexpr double kMostLookYaw = 60;    ///< degrees, to each side
inline constexpr double kMostLookPitch = 40;  ///< degrees, up and down

/// A target of the eyes.
struct Look {
  /// Kinds of targets.
  enum class Kind : std::uint8_t {
    camera,     ///< the viewer: straight ahead, 1.2 m away
    away,       ///< anything but the viewer
    direction,  ///< `yaw` and `pitch`, 2 m away
    point,      ///< `x`, `y`, `z`
  };
  Kind kind = Kind::camera;  ///< which of the values count
  double yaw = 0;            ///< degrees to the person's left, -60..60
  double pitch = 0;          ///< degrees up, -40..40
  double x = 0;              ///< metres to the person's left of the middle between the eyes
  double y = 0;              ///< metres up
  double z = 1;              ///< metres ahead, 0.1..1000
  friend bool operator==(const Look&, const Look&) = default;
};

/// Reads one of the four forms of the page's head; blanks around numbers are allowed. Errors:
/// syntax (none of them), out_of_range (beyond kMostLookYaw or kMostLookPitch, also for points; a
/// point behind the face).
Result<Look> parse_look(std::string_view text);

/// The text that parse_look() reads.
std::string format_look(const Look& look);

}  // namespace animeme::dam
