/// @file
/// Converts captures of any tracker to one kind of table, and selects the reader for it.
///
///     auto capture = animeme::exchange::capture_table(text);
///     if (!capture) return capture.error();      // says what the file is, and what to do
///     switch (capture->kind) ...                 // import_landmarks(capture->table, ...)
///
/// Besides tables with one row per frame, these are accepted:
///
/// - One row per point: columns x, y, optionally z, and one that names the point (point, landmark,
/// index, id,
///   keypoint, marker, name ...); frames end where time, frame or face_id change.
/// - JSON, one value or one a line: frames as an array, or as `frames`, `results`, `data` of an
///   object. A frame is an array of points, or an object with faceLandmarks, face_landmarks,
///   landmarks, multiFaceLandmarks, keypoints, points or scaledMesh: points {x, y, z} or [x, y, z],
///   or an array of faces, of which the first is used. Its time is time_s, time, timestamp or t in
///   seconds, timestamp_ms or time_ms; its number frame or index. A frame without points has no
///   face. `width` and `height` next to the frames are the picture's size. Blend shapes
///   (faceBlendshapes, blendshapes) are used if there are no points, or on request.
/// - JSON of ARKit's shapes in any structure: detail/json_curves.h (animeme-arkit, Audio2Face,
/// BEAT,
///   Azure Speech, lists of dictionaries, MediaPipe).
/// - Packets of iFacialMocap and Facemotion3d ("mouthSmile_R-0|jawOpen-12|..."), one a line.
/// - Action units (AU01_r, AU12 ...) of OpenFace, LibreFace and Py-Feat, where there are no points.
/// - Decimal commas, if semicolons or tabs separate the fields.
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

/// The reader of a table.
enum class CaptureKind : std::uint8_t {
  arkit,      ///< read_arkit_table()
  landmarks,  ///< import_landmarks()
  faps        ///< dam::read_curves()
};

/// A capture as a table with one row per frame.
struct CaptureTable {
  CaptureKind kind = CaptureKind::landmarks;  ///< the reader to use
  std::string table;                          ///< with a header line
  std::optional<PictureSize> size;            ///< from JSON
  std::optional<fap::LandmarkLayout> layout;  ///< from JSON
  std::vector<std::string> warnings;          ///< what was assumed
};

/// Options for reading a capture.
struct CaptureTableOptions {
  ColumnMap columns;    ///< meanings of columns with unknown names
  bool shapes = false;  ///< prefer blend shapes if JSON has points and blend shapes
};

/// Errors: unsupported (another kind of file, with advice: see foreign_file()), truncated (empty),
/// not_found (an unknown table; the message lists its columns), and those of rename_columns(), of
/// JSON and of tables with one row per point.
Result<CaptureTable> capture_table(std::string_view text, const CaptureTableOptions& options = {});

/// Does a table have a time column?
bool has_times(std::string_view table);

/// Identifies bytes that are not a capture, with advice, as a sentence: compressed files,
/// spreadsheets, numpy arrays, pictures, sound, videos, scripts, heads, body motion, UTF-16 text,
/// FAP text and streams. Empty: unknown.
std::string foreign_file(std::span<const std::uint8_t> bytes);
/// The same for files that are recognised by their first bytes; these do not include videos.
std::string foreign_sign(std::span<const std::uint8_t> bytes);

}  // namespace animeme::exchange
