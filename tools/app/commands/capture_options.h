/// @file
/// Options of the commands that read captures of a face.
#pragma once

#include <string>
#include <vector>

#include "tools/app/commands/common.h"
#include "tools/characters/capture/read_capture.h"

namespace animeme::tools {

inline constexpr const char* kLandmarkGroup = "Landmarks";  ///< of options in --help

/// What the user said; capture_settings() makes sense of it.
struct CaptureOptions {
  std::string rate;                  ///< --rate
  bool degrees = false;              ///< --degrees
  bool no_repair = false;            ///< --no-repair
  std::string layout;                ///< --layout
  std::string size;                  ///< --size
  std::string pixel_aspect;          ///< --pixel-aspect
  int face = -1;                     ///< --face
  std::vector<std::string> columns;  ///< --column
  std::string column_file;           ///< --columns
  std::string tracker;               ///< --tracker
  CaptureSettings settings;          ///< what needs no parsing
  bool for_landmarks = false;        ///< an option was given that only landmarks know
};

/// Adds all of them.
void add_capture_options(OptionTable& cli, CaptureOptions& options);
/// Adds --neutral-from and --face-file.
void add_neutral_options(OptionTable& cli, NeutralSource& source);

/// Errors: invalid_argument and those of reading --columns; all are errors of usage.
Result<CaptureSettings> capture_settings(const CaptureOptions& options);

}  // namespace animeme::tools
