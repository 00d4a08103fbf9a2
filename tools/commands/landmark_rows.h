/// @file
/// The rows of a table of landmarks.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fap/landmarks.h"
#include "fap/result.h"
#include "tools/commands/arkit_times.h"
#include "tools/commands/landmark_columns.h"

namespace animeme::tools {

struct LandmarkRowOptions {
  std::optional<int> face;  ///< face_id to read; nothing: the first
  double confidence = 0.5;  ///< rows with less are left out
};

struct LandmarkRow {
  std::size_t line = 0;
  std::optional<TimeField> time;
  std::optional<double> frame;
  fap::LandmarkFrame seen;  ///< without number; x, y and z as they stand there
};

/// Why rows were left out, and how many points were not seen.
struct LeftOutRows {
  std::size_t unsure = 0;
  std::size_t other_faces = 0;
  std::size_t blind = 0;
};

struct LandmarkRows {
  std::vector<LandmarkRow> rows;
  LeftOutRows left_out;
};

/// Reads all lines behind the first. Errors: syntax, with line and column.
Result<LandmarkRows> read_landmark_rows(const std::vector<dam::TableLine>& lines,
                                        const LandmarkColumns& columns,
                                        const LandmarkRowOptions& options);

}  // namespace animeme::tools
