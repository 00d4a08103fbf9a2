/// @file
/// Captures of any tracker as one kind of table: which reader of this folder is for them.
///
///     auto capture = animeme::exchange::capture_table(text);
///     if (!capture) return capture.error();      // says what the file is, and what to do
///     switch (capture->kind) ...                 // import_landmarks(capture->table, ...)
///
/// Beside tables with a row a frame these are taken:
///
/// - A row a point: columns x, y, maybe z, and one that names the point (point, landmark, index,
/// id,
///   keypoint, marker, name ...); frames end where time, frame or face_id change.
/// - JSON, one value or one a line: frames as an array, or as `frames`, `results`, `data` of an
///   object. A frame is an array of points, or an object with faceLandmarks, face_landmarks,
///   landmarks, multiFaceLandmarks, keypoints, points or scaledMesh: points {x, y, z} or [x, y, z],
///   or an array of faces, of which the first counts. Its time is time_s, time, timestamp or t in
///   seconds, timestamp_ms or time_ms; its number frame or index. A frame without points is one
///   without a face. `width` and `height` beside the frames are the picture's size. Blend shapes
///   (faceBlendshapes, blendshapes) are taken if there are no points, or if asked for.
/// - Decimal commas, where semicolons or tabs part the fields.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/formats/exchange/column_map.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

/// Which reader a table is for.
enum class CaptureKind : std::uint8_t {
  arkit,      ///< read_arkit_table()
  landmarks,  ///< import_landmarks()
  faps        ///< dam::read_curves()
};

/// A capture as a table with a row a frame.
struct CaptureTable {
  CaptureKind kind = CaptureKind::landmarks;  ///< which reader is for it
  std::string table;                          ///< with a header line
  std::optional<PictureSize> size;            ///< as a JSON tells it
  std::optional<fap::LandmarkLayout> layout;  ///< likewise
  std::vector<std::string> warnings;          ///< what was assumed
};

/// What is wanted of a capture.
struct CaptureTableOptions {
  ColumnMap columns;    ///< what columns are whose names say nothing
  bool shapes = false;  ///< of a JSON with points and blend shapes the blend shapes
};

/// Errors: what a file is instead and what to do with it (unsupported: see foreign_file()),
/// truncated (empty), not_found (a table of something else; its columns are named), and those of
/// rename_columns(), of JSON and of tables with a row a point.
Result<CaptureTable> capture_table(std::string_view text, const CaptureTableOptions& options = {});

/// Has a table a column of times?
bool has_times(std::string_view table);

/// What bytes are that are no capture, and what to do with them, as a sentence: packed files,
/// spreadsheets, arrays of numpy, pictures, sound, videos, scripts, heads, motion of bodies, text
/// in UTF-16, FAP text and streams. Empty: nothing that is known.
std::string foreign_file(std::span<const std::uint8_t> bytes);
/// The same of files that say it with their first bytes: a video is none of them.
std::string foreign_sign(std::span<const std::uint8_t> bytes);

}  // namespace animeme::exchange
