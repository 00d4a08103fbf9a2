/// @file
/// The rows of a table of landmarks.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fap/result.h"
#include "tools/formats/exchange/detail/landmark_columns.h"
#include "tools/formats/exchange/detail/times.h"

namespace animeme::exchange {

/// A row that counts.
struct LandmarkRow {
  std::size_t line = 0;
  std::optional<RowTime> time;
  std::optional<double> frame;
  fap::LandmarkFrame seen;  ///< without number; x, y and z as they stand there
};

/// Why rows were left out, and how many points were not seen.
struct LeftOutRows {
  std::size_t unsure = 0;       ///< confidence too low, or no success
  std::size_t other_faces = 0;  ///< another face_id
  std::size_t blind = 0;        ///< points without numbers
};

/// What a table holds.
struct LandmarkRows {
  std::vector<LandmarkRow> rows;      ///< in the order of the file
  std::optional<RowTime> first_time;  ///< of the first row of all, be it left out or not
  std::optional<double> first_frame;  ///< likewise
  LeftOutRows left_out;               ///< and why
};

/// Reads all lines behind the first, whose fields `separator` divides. Errors: syntax, with line
/// and column.
Result<LandmarkRows> read_landmark_rows(const std::vector<dam::TableLine>& lines, char separator,
                                        const LandmarkColumns& columns,
                                        const LandmarkTableOptions& options);

}  // namespace animeme::exchange
