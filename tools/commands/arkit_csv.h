/// @file
/// Tables of ARKit blend shapes: Live Link Face recordings and corpus curves.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/frame.h"
#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::tools {

/// What the user says of a table.
struct ArkitCsvOptions {
  std::optional<fap::Rate> rate;  ///< nothing: told from the times
  bool degrees = false;           ///< the angles of head and eyes are degrees, not radians
};

/// True if the first line of a text names two ARKit shapes at least: read_arkit_csv() is for it.
bool is_arkit_csv(std::string_view text);

/// Reads a table with a header line, fields between commas, semicolons or tabs:
///
///     Timecode,BlendShapeCount,EyeBlinkLeft,...          Live Link Face
///     time_s,browDownLeft,browDownRight,...              corpus curves
///
/// Times are the column timecode, time_s, time or timestamp, in seconds ("1.0333") or as
/// hh:mm:ss:ff.fff, where .fff is a fraction of a timecode frame. Timecode frames a second are the
/// smallest of 24, 25, 30, 48, 50, 60, 100, 120 that no frame number reaches, or fewer if rows
/// count up by one and never get that far; in a take within one second, what fits options.rate,
/// else 60 with a warning. The rest are channels (fap/arkit.h, any case); missing ones are 0, and
/// an angle that is 0 throughout counts as missing. Columns that are no channel are left out and
/// named in `warnings`.
///
/// The rate is that of the median step, snapped to a rate in common use (10 to 120, NTSC ones
/// included) within 1 %, else to one that FBA can code (k/16). Timecodes count whole frames,
/// so 29.97 is 30 there unless options.rate says otherwise. Each row becomes the frame next to its
/// time; steps that are a little off do not matter, larger ones leave frame numbers out (skipped
/// frames). Of rows that fall on the same frame the last one counts. Rows of Live Link Face without
/// a face (BlendShapeCount 0) are left out likewise.
///
/// Errors, with line and column: truncated (no rows), not_found (no time, no channel), syntax (a
/// field that is no number, missing fields, a column named twice), out_of_range (times that go
/// back or span more than 10 million frames), invalid_argument (a single row and no rate).
Result<fap::Sequence> read_arkit_csv(std::string_view text, const ArkitCsvOptions& options,
                                     std::vector<std::string>& warnings);

}  // namespace animeme::tools
