/// @file
/// ARKit curves as other programs read them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/arkit.h"
#include "fap/rate.h"

namespace animeme::tools {

/// One frame after the other, from time 0.
struct ArkitCurves {
  fap::Rate rate;                       ///< frames a second
  std::vector<fap::ArkitFrame> frames;  ///< one after the other
};

/// The table that Live Link Face writes: Timecode (hh:mm:ss:ff.fff, frames of the next whole
/// rate), BlendShapeCount 61, then the channels of fap::kArkitNames with a capital first letter,
/// six decimals. read_arkit_csv() reads it back.
std::string live_link_csv(const ArkitCurves& curves);

/// {"format": "animeme-arkit", "version": 1, "fps": 25.0, "rate": [25, 1], "audio": null,
///  "names": [61 names], "frames": [[61 numbers], ...]}, angles in radians, a line a frame. `audio`
/// is the name of the sound beside it; empty: null.
std::string arkit_json(const ArkitCurves& curves, std::string_view audio);

}  // namespace animeme::tools
