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

/// Which rows count.
struct LandmarkRowOptions {
  std::optional<int> face;  ///< face_id to read; nothing: the first
  double confidence = 0.5;  ///< rows with less are left out
};

/// A row that counts.
struct LandmarkRow {
  std::size_t line = 0;           ///< of the file, from 1
  std::optional<TimeField> time;  ///< nothing: the table has none
  std::optional<double> frame;    ///< nothing: the table has none
  fap::LandmarkFrame seen;        ///< without number; x, y and z as they stand there
};

/// Why rows were left out, and how many points were not seen.
struct LeftOutRows {
  std::size_t unsure = 0;       ///< confidence too low, or no success
  std::size_t other_faces = 0;  ///< another face_id
  std::size_t blind = 0;        ///< points without numbers
};

/// What a table holds.
struct LandmarkRows {
  std::vector<LandmarkRow> rows;  ///< in the order of the file
  LeftOutRows left_out;           ///< and why
};

/// Reads all lines behind the first. Errors: syntax, with line and column.
Result<LandmarkRows> read_landmark_rows(const std::vector<dam::TableLine>& lines,
                                        const LandmarkColumns& columns,
                                        const LandmarkRowOptions& options);

}  // namespace animeme::tools
