/// @file
/// Tables of tracked landmarks of a face: OpenFace, dlib, MediaPipe, feature points of MPEG-4.
///
///     auto take = animeme::exchange::import_landmarks(text);
///     if (take) use(take->face.clip, take->warnings);
///
/// fap/landmarks.h documents the conversion of points to FAPs and the neutral face. Messages
/// suggest options of `animeme import` (--rate, --size ...), which are given with the members
/// below.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/landmarks.h"
#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::exchange {

/// Size of the tracked video, in any unit: only the ratio matters.
struct PictureSize {
  double width = 0;   ///< > 0
  double height = 0;  ///< > 0
};

/// "1280x720" or "16:9", each below a million; otherwise nullopt.
std::optional<PictureSize> parse_picture_size(std::string_view text);

/// Options for reading a table.
struct LandmarkTableOptions {
  std::optional<fap::Rate> rate;              ///< --rate; valid; nullopt: from the times
  std::optional<fap::LandmarkLayout> layout;  ///< --layout; nullopt: from the number of points
  bool flat = false;                          ///< --flat: ignore depth
  std::optional<PictureSize>
      size;                 ///< --size of the picture if x and y are fractions of it, see below
  double pixel_aspect = 1;  ///< --pixel-aspect: width of a pixel / height; 0.01 to 100
  double depth_scale =
      1;  ///< --depth-scale: multiplies z to get the unit of x and y; finite, not 0
  std::optional<int> face;  ///< --face: face_id to read; nullopt: the first
  double confidence = 0.5;  ///< --confidence: rows below it are dropped
};

/// The points of a recording.
struct LandmarkTable {
  /// At least one frame. Number 0 is the first row of the table, even if it has no face.
  fap::LandmarkTrack track;
  std::optional<double> start;        ///< seconds of number 0 in the table; not for timecodes
  std::vector<std::string> warnings;  ///< sentences for the user: what was dropped or guessed
};

/// Whether the first line of a text names all points of a layout, or at least four feature points
/// of MPEG-4, so that read_landmark_table() applies.
bool is_landmark_table(std::string_view text);

/// Reads a table with a header line, fields separated by commas, semicolons or tabs. Column names,
/// case-insensitive unless a table has both X and x:
///
///     x_0, y_0, x0, X_0 ... z_67       OpenFace; if there are both, X, Y, Z are the points in
///                                      space and x, y those of the picture, used if `flat`
///     landmark_0_x, lm0_x, p0x, 0_x    and the like
///     8.1_x, fp8.1_x, nasion_x         feature points of MPEG-4
///     timecode, time_s, time, timestamp, frame, face_id, confidence, success, pose_Rx ... Rz,
///     gaze_0_x ... gaze_1_z, gaze_angle_x, gaze_angle_y
///
/// Numbers count from 0, or from 1 if there is no 0. Other columns are ignored. A part of a layout
/// is enough if it has at least four feature points; numbers beyond 67 are those of MediaPipe.
///
/// - Times and the rate are those of read_arkit_table(). Without times, or if all are equal
///   (OpenFace on pictures), `rate` is required; rows are numbered by `frame`, or consecutively.
/// - Rows with success 0, a confidence below the limit or another face become skipped frames; an
/// empty or nan coordinate is a missing point.
/// - x and y of MediaPipe are fractions of the picture's width and height if all lie between -0.5
/// and
///   1.5 (z has the unit of x). `size` is its size; by default, that of 16:9, 4:3, 1:1, 3:4 and
///   9:16 is used that gives a face of usual proportions (between the outer corners of the eyes it
///   is 1.9 times as wide as from there to the base of the nose: mean of two head models), and a
///   warning reports the estimate. If another of these would fit much better (by 15 %) than the
///   given size or pixel aspect, there is a warning, both for fractions and for pixels, since the
///   jaw would be scaled by the same error.
/// - With depth, the tip of the nose protrudes before the line of the outer corners of the eyes by
/// 0.1 to 2 times their distance (0.5 on two head models). Otherwise z has another unit; then depth
/// is ignored, with a warning.
/// - OpenFace: axes of the camera are x right, y down, z away, so FAP 48 is pose_Rx, and Ry and Rz
///   change their sign; gaze_0 is the eye on the left of the picture, the person's right eye.
///
/// Errors, with line and column: truncated (no rows), syntax (a field that is not a number, missing
/// fields, a duplicate column), not_found (no points; points of an unknown layout; points without x
/// or y; no such face), invalid_argument (no times and no rate; the rate as in read_arkit_table()),
/// out_of_range (times that go back or span more than 10 million frames).
Result<LandmarkTable> read_landmark_table(std::string_view text,
                                          const LandmarkTableOptions& options = {});

/// Repairs made by repair_track().
struct Repairs {
  std::size_t glitches = 0;        ///< frames dropped because the whole face jumped
  std::size_t slips = 0;           ///< points dropped because they jumped
  std::size_t filled_frames = 0;   ///< interpolated: gaps of at most 0.2 s
  std::size_t filled_points = 0;   ///< interpolated single points
  std::size_t gaps = 0;            ///< longer gaps, which remain
  double longest_gap = 0;          ///< seconds of the longest remaining gap
  std::vector<std::int64_t> made;  ///< numbers of the filled frames, ascending
};

/// Repairs tracking errors that are impossible as facial motion:
///
/// - The whole face jumps by 0.4 of the distance of the outer corners of its eyes (3.6 cm), or
/// changes its size by a quarter, eyes included, for at most 0.2 s, and back: these frames are
/// dropped.
/// - A point jumps on the face by as much for at most 0.1 s, and back: it is marked as missing. No
/// head or jaw moves that far between two frames. For a track without eyes, the limit is twice the
/// distance within which nine of ten points lie (2 cm for lips).
/// - Gaps of frames and points of at most 0.2 s are interpolated linearly between their neighbours,
/// and so are head rotation and gaze.
///
/// Longer gaps remain. A recording with fewer than 15 frames a second is not changed.
Repairs repair_track(fap::LandmarkTrack& track);

/// Options for converting points to a clip.
struct LandmarkImportOptions {
  LandmarkTableOptions table;  ///< for reading the table
  /// --neutral: frame numbers of the neutral face in the clip, "12" or "0-24", or times of the
  /// clip, "1.5s" or "0.5-1.2s" (both may have an s). Empty: automatic.
  std::string neutral;
  bool repair = true;         ///< --no-repair: false skips repair_track()
  fap::LandmarkOptions face;  ///< `neutral` of it is not used; `rest` is the neutral face if given
};

/// Result of an import.
struct LandmarkImport {
  fap::LandmarkFace face;             ///< the clip and its units; without a name
  bool depth = false;                 ///< the points are 3D
  Repairs repairs;                    ///< repairs made
  std::optional<double> start;        ///< see LandmarkTable
  std::vector<std::string> warnings;  ///< those of the table; dropped frames; an unsteady head
};

/// Reads a table and turns it into FAPs. Errors: those of read_landmark_table() and
/// fap::landmarks_to_fap(); invalid_argument (a neutral part that is not understood or has no
/// frames).
Result<LandmarkImport> import_landmarks(std::string_view text,
                                        const LandmarkImportOptions& options = {});

/// The same from a table that was already read; `options.table` is ignored.
Result<LandmarkImport> import_landmarks(LandmarkTable table, const LandmarkImportOptions& options);

/// A common neutral face of several recordings of a person, found as in landmarks_to_fap() among
/// all frames, or at `options.neutral` of a single recording. So recordings without a face at rest
/// (a mouth that never closes) use that of the others. Their units may differ: sizes are
/// normalised, and the result has the size of the first neutral frame.
///
/// Errors: invalid_argument (no table; tables with different points or depth; a part of a clip if
/// there are several), those of fap::landmarks_to_fap().
Result<fap::RestingFace> common_face(const std::vector<LandmarkTable>& tables,
                                     const LandmarkImportOptions& options = {});

}  // namespace animeme::exchange
