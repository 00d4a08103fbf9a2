/// @file
/// Landmarks as JSON, as scripts around MediaPipe, TensorFlow.js and dlib write them, as a table.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

/// What a JSON text holds, as a table with a header line, and what it says beside it.
struct JsonTable {
  std::string table;                          ///< for read_landmark_table() or read_arkit_table()
  std::optional<PictureSize> size;            ///< width and height of the picture
  std::optional<fap::LandmarkLayout> layout;  ///< by the number of points
  std::vector<std::string> warnings;          ///< what was left out or assumed
};

/// True if a text begins as JSON does: '{' or '['.
bool is_json(std::string_view text);

/// Reads one value, or one a line. See capture_table() for what is understood. Errors: syntax (no
/// JSON; a coordinate that is no number; frames with different numbers of points), not_found (no
/// landmarks and no blend shapes), truncated (no frames).
Result<JsonTable> json_to_table(std::string_view text, bool shapes);

}  // namespace animeme::exchange
