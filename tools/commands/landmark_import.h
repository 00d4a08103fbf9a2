/// @file
/// Tracked landmarks as a clip, with what `animeme import` lets the user say.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"
#include "tools/commands/landmark_csv.h"

namespace animeme::tools {

/// What the user says of a recording.
struct LandmarkImportOptions {
  LandmarkCsvOptions table;  ///< how the table is read
  /// Frames of the neutral face as they are numbered in the clip, "12" or "0-24", or times of the
  /// clip, "1.5s" or "0.5-1.2s" (s may stand behind both). Empty: found.
  std::string neutral;
  fap::LandmarkOptions face;  ///< `neutral` of it is not used
};

/// What came of it.
struct LandmarkImport {
  fap::Sequence clip;  ///< frames with a face
  std::string talk;    ///< what was found, for people
};

/// Reads a table and turns it into FAPs. Errors: those of read_landmark_csv() and
/// landmarks_to_fap(); invalid_argument (a neutral part that is not understood or has no frames).
Result<LandmarkImport> import_landmarks(std::string_view text, const LandmarkImportOptions& options,
                                        std::vector<std::string>& warnings);

}  // namespace animeme::tools
