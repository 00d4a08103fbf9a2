/// @file
/// Tables of tracked landmarks of a face: OpenFace, dlib, MediaPipe, feature points of MPEG-4.
///
///     auto take = animeme::exchange::import_landmarks(text);
///     if (take) use(take->face.clip, take->warnings);
///
/// How points become FAPs, and what a neutral face is, is told in fap/landmarks.h. Messages name
/// the options of `animeme import` as remedies (--rate, --size ...); the members below say theirs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/landmarks.h"
#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::exchange {

/// Of the video that was tracked, in any unit: only the quotient counts.
struct PictureSize {
  double width = 0;   ///< > 0
  double height = 0;  ///< > 0
};

/// "1280x720" or "16:9", each below a million; nothing if it is something else.
std::optional<PictureSize> parse_picture_size(std::string_view text);

/// How a table is read.
struct LandmarkTableOptions {
  std::optional<fap::Rate> rate;              ///< --rate; valid; nothing: told from the times
  std::optional<fap::LandmarkLayout> layout;  ///< --layout; nothing: told by the number of points
  bool flat = false;                          ///< --flat: leave out what is known of depth
  std::optional<PictureSize> size;  ///< --size of the picture whose shares x and y are, see below
  double pixel_aspect = 1;  ///< --pixel-aspect: how wide a pixel is if it is 1 high; 0.01 to 100
  double depth_scale = 1;   ///< --depth-scale: z times this has the unit of x and y; finite, not 0
  std::optional<int> face;  ///< --face: face_id to read; nothing: the first
  double confidence = 0.5;  ///< --confidence: rows with less are left out
};

/// The points of a recording.
struct LandmarkTable {
  /// One frame at least. Number 0 is the first row of the table, be there a face in it or not.
  fap::LandmarkTrack track;
  std::optional<double> start;        ///< seconds of number 0 as the table tells; no timecodes
  std::vector<std::string> warnings;  ///< sentences for people: what was left out or guessed
};

/// True if the first line of a text names all points of a layout, or four feature points of MPEG-4
/// at least: read_landmark_table() is for it.
bool is_landmark_table(std::string_view text);

/// Reads a table with a header line, fields between commas, semicolons or tabs. Names of columns,
/// in any case but for X and x where there are both:
///
///     x_0, y_0, x0, X_0 ... z_67       OpenFace; where both are there X, Y, Z are the points in
///                                      space and x, y those of the picture, which count if `flat`
///     landmark_0_x, lm0_x, p0x, 0_x    and the like
///     8.1_x, fp8.1_x, nasion_x         feature points of MPEG-4
///     timecode, time_s, time, timestamp, frame, face_id, confidence, success, pose_Rx ... Rz,
///     gaze_0_x ... gaze_1_z, gaze_angle_x, gaze_angle_y
///
/// Numbers count from 0, or from 1 if there is no 0. Other columns are left out. Of a layout a part
/// will do, if it has four feature points at least: numbers beyond 67 are those of MediaPipe.
///
/// - Times and the rate are those of read_arkit_table(). Without times, or if all are equal
///   (OpenFace on pictures), `rate` has to be given: rows count by `frame`, or one after the other.
/// - Rows with success 0, a confidence below the limit or of another face are left out and become
///   skipped frames; a coordinate that is empty or nan is a point that was not seen.
/// - x and y of MediaPipe are shares of the picture's width and height if all lie between -0.5 and
///   1.5 (z has the unit of x). `size` says how wide and high it is; without it, the one of 16:9,
///   4:3, 1:1, 3:4 and 9:16 is taken that gives a face of usual proportions (between the outer
///   corners of the eyes it is 1.9 times as wide as from there to the base of the nose: mean of two
///   head models), an estimate that the warnings tell. A size or shape of the pixels in which
///   another of these would give the usual proportions by far (15 %) rather is warned of, whether
///   points are shares or pixels: the jaw would be scaled by the same error.
/// - With depth, the tip of the nose stands out by 0.1 to 2 times the distance of the outer corners
///   of the eyes before their line (0.5 on two head models); of z in another unit it does not,
///   which is warned of, and depth is left out.
/// - OpenFace: axes of the camera are x right, y down, z away, so FAP 48 is pose_Rx, and Ry and Rz
///   change their sign; gaze_0 is the eye on the left of the picture, the person's right one.
///
/// Errors, with line and column: truncated (no rows), syntax (a field that is no number, missing
/// fields, a column that is there twice), not_found (no points; points whose layout cannot be told;
/// points without x or y; no such face), invalid_argument (no times and no rate; the rate as in
/// read_arkit_table()), out_of_range (times that go back or span more than 10 million frames).
Result<LandmarkTable> read_landmark_table(std::string_view text,
                                          const LandmarkTableOptions& options = {});

/// What repair_track() has done to a recording.
struct Repairs {
  std::size_t glitches = 0;        ///< frames in which the whole face was elsewhere, left out
  std::size_t slips = 0;           ///< points that jumped and came back, left out
  std::size_t filled_frames = 0;   ///< put between their neighbours: gaps of at most 0.2 s
  std::size_t filled_points = 0;   ///< likewise, single points
  std::size_t gaps = 0;            ///< longer ones, which stay
  double longest_gap = 0;          ///< seconds of the longest that stays
  std::vector<std::int64_t> made;  ///< numbers of the filled frames, ascending
};

/// Repairs what trackers do wrong, and only what no face does:
///
/// - The whole face is elsewhere, by 0.4 of the distance of the outer corners of its eyes (3.6 cm),
///   or of another size, by a quarter, eyes included, for at most 0.2 s, and back: these frames are
///   left out.
/// - A point is elsewhere on the face, by as much, for at most 0.1 s, and back: it is not seen
///   there. No head and no jaw goes that far from one frame to the next. Of a track without eyes
///   twice the distance within which nine of ten points lie takes its place (2 cm of lips).
/// - Missing frames and points of at most 0.2 s with neighbours on both sides lie on the line
///   between these; so do turns of the head and gazes.
///
/// Longer gaps stay. A recording of fewer than 15 frames a second is left as it is.
Repairs repair_track(fap::LandmarkTrack& track);

/// How the points of a table become a clip.
struct LandmarkImportOptions {
  LandmarkTableOptions table;  ///< how the table is read
  /// --neutral: frames of the neutral face as they are numbered in the clip, "12" or "0-24", or
  /// times of the clip, "1.5s" or "0.5-1.2s" (s may stand behind both). Empty: found.
  std::string neutral;
  bool repair = true;         ///< --no-repair: repair_track() is left out
  fap::LandmarkOptions face;  ///< `neutral` of it is not used; `rest` is the neutral face if given
};

/// What came of it.
struct LandmarkImport {
  fap::LandmarkFace face;             ///< the clip and its units; without a name
  bool depth = false;                 ///< points in space, not in a picture
  Repairs repairs;                    ///< what was repaired
  std::optional<double> start;        ///< see LandmarkTable
  std::vector<std::string> warnings;  ///< those of the table, frames left out, a shaky head
};

/// Reads a table and turns it into FAPs. Errors: those of read_landmark_table() and
/// fap::landmarks_to_fap(); invalid_argument (a neutral part that is not understood or has no
/// frames).
Result<LandmarkImport> import_landmarks(std::string_view text,
                                        const LandmarkImportOptions& options = {});

/// The same from a table that was read. Of its options only those of this struct count.
Result<LandmarkImport> import_landmarks(LandmarkTable table, const LandmarkImportOptions& options);

/// One neutral face of several recordings of a person: found as landmarks_to_fap() does, in all of
/// their frames, or at `options.neutral` of the only one. Recordings without a face at rest
/// (a mouth that never closes) then borrow that of the others. Their units may differ: the size of
/// the head is taken off, the result has that of the first frame that is neutral.
///
/// Errors: invalid_argument (no table; tables with different points or depth; a part of a clip if
/// there are several), those of fap::landmarks_to_fap().
Result<fap::RestingFace> common_face(const std::vector<LandmarkTable>& tables,
                                     const LandmarkImportOptions& options = {});

}  // namespace animeme::exchange
