/// @file
/// FAPs from tracked face points, as OpenFace, MediaPipe and similar trackers find them in a video.
///
///     animeme::fap::LandmarkTrack track{{30, 1}, {"2.1", "2.2", ...}, false, frames};
///     auto face = animeme::fap::landmarks_to_fap(track);
///     if (face) write(face->clip);
///
/// A FAP is the displacement of a feature point on the head, in units of the neutral face. So the
/// pose of the head (position, size and rotation) is estimated in each frame and removed, and the
/// remaining displacement from the neutral face is measured along the axis of the FAP: value =
/// distance / FAPU * 1024.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/fapu.h"
#include "fap/frame.h"
#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::fap {

/// In addition to kFeaturePoints: the root of the nose, between the eyes.
inline constexpr std::string_view kNasion = "nasion";

/// The source of a feature point: a landmark of a tracker, or the mean of two.
struct LandmarkSource {
  std::string_view point;  ///< id of kFeaturePoints, or kNasion
  int landmark = 0;        ///< number, from 0
  int second = -1;         ///< -1: there is no second one
};

/// Sets of landmarks in common use. Numbers count from 0.
enum class LandmarkLayout : std::uint8_t {
  ibug68,     ///< 68 points of iBUG 300-W and Multi-PIE: OpenFace, dlib, face-alignment
  mediapipe,  ///< 468 points of MediaPipe Face Mesh; 468 and 473 are the irises if there are 478
};

/// The landmarks of each feature point; landmark_maps.cpp has the reasons.
std::span<const LandmarkSource> landmark_sources(LandmarkLayout layout);

/// Angles of a head in rad, with the signs of FAP 48, 49 and 50: down, to the left, to the right
/// are positive; yaw is outermost, then pitch, then roll, as in Greta (fap/semantics.md, section
/// 1).
struct HeadPose {
  double pitch = 0;  ///< rad, down
  double yaw = 0;    ///< rad, to the person's left
  double roll = 0;   ///< rad, to the person's right
};

/// One instant of a recording.
struct LandmarkFrame {
  std::int64_t number = 0;  ///< at the rate of the track; ascending
  /// Position of each point of the track; NaN: not seen. Without depth, z is ignored.
  std::vector<Point> at;
  /// Rotation of the head relative to the camera, if the tracker provides it. Used without depth
  /// only: with depth it follows from the points.
  std::optional<HeadPose> head;
  /// Gaze direction of the person's left and right eye, any length: +X to the person's left, +Y up,
  /// +Z towards the camera. Eyes without one use the pupils (3.5, 3.6), if present.
  std::array<std::optional<Point>, 2> gaze;
};

/// A recording. Axes and lengths are those of the tracker: pixels, millimetres, anything with the
/// same unit for x, y (and z). The direction of the axes is inferred from the face: the eyes are
/// above the mouth, the left eye is on the left, the nose stands out. Points are named from the
/// person's view: the person's left eye is on the right of an image that is not mirrored.
struct LandmarkTrack {
  Rate rate;                          ///< of the recording
  std::vector<std::string> points;    ///< ids: kFeaturePoints or kNasion
  bool depth = false;                 ///< z is known
  std::vector<LandmarkFrame> frames;  ///< by ascending number
};

/// Gaze of an eye relative to the head, in rad.
struct EyeTurn {
  double yaw = 0;    ///< to the person's left
  double pitch = 0;  ///< down
};

/// A neutral face on its own, so that several recordings of a person share one neutral face and one
/// set of units. Otherwise each recording finds its own.
struct RestingFace {
  bool depth = false;    ///< measured with depth; without, z is 0
  FeaturePoints points;  ///< upright and facing +Z; in units of the track it was measured in
  Fapu fapu;             ///< of these points, or given by the caller; all > 0
  HeadPose turn;         ///< of the head relative to the camera, at rest
  std::array<std::optional<EyeTurn>, 2> gaze;  ///< of the left and the right eye, at rest
};

/// Options of landmarks_to_fap().
struct LandmarkOptions {
  /// Frames (their indices) of the neutral face: eyes open, mouth closed, looking at the camera.
  /// Their points are combined by the median. Empty: detected, see landmarks_to_fap().
  std::vector<std::size_t> neutral;
  /// Standard deviation (seconds, 0..1) of the Gaussian smoothing over time; it is symmetric, so it
  /// adds no delay. 0: no smoothing. The default removes jitter from frame to frame at 50 or 60
  /// frames per second and hardly affects speech: it keeps 91 % of a motion at 5 Hz, 73 % at 9 Hz.
  double smooth = 0.014;
  bool mirrored = false;  ///< the image was mirrored, as by selfie cameras: swap left and right
  /// The neutral face of another recording (LandmarkFace::rest); `neutral` is not used then. The
  /// size of the head in the image may differ. If the track has too few points of the head (below),
  /// head motion is assumed to be removed already, with position and size of this face.
  std::optional<RestingFace> rest;
};

/// Result of landmarks_to_fap().
struct LandmarkFace {
  Sequence clip;                             ///< frames of the track whose head was found
  Fapu fapu;                                 ///< in units of the track, at neutral
  std::vector<std::int64_t> neutral_frames;  ///< numbers of the neutral frames used, if any
  std::size_t lost = 0;                      ///< frames omitted: too few points of the head seen
  /// Root mean square distance of the rigid points of the head from their fitted position, as a
  /// share of ES: noise of the tracker, or a wrong head pose.
  double head_error = 0;
  RestingFace rest = {};  ///< the neutral face that values were measured against, with `fapu`
};

/// FAPs of a recording.
///
/// - The head: a rotation, scale and translation per frame from the points that do not move with
///   facial expressions: corners of the eyes (3.7, 3.8, 3.11, 3.12), the nose except its tip and
///   wings (9.6, 9.7, 9.12 to 9.15, nasion), hairline (11.1 to 11.3) and ears (10.7 to 10.10).
///   Outliers have less weight. Without depth the rotation is in the image plane only.
/// - FAP 48 to 50: rotation of the head relative to that of the neutral face; with depth from the
///   fit, else from LandmarkFrame::head, else FAP 50 only.
/// - FAPs of all feature points of the track except pupil size and eyeball depth (FAP 27 to 30);
///   without depth, those along Z (14, 16, 17, 45) are omitted. Without depth a head that turns or
///   nods looks like a face that moves: the camera should see it from the front, and head_error
///   measures the violation.
/// - Eyeballs (FAP 23 to 26): gaze relative to the head and to the neutral gaze. From pupils, with
///   an estimated eyeball radius of 0.18 ES (11.5 mm at 63 mm between the pupils, means of adults).
/// - IRISD is the opening of the neutral lids; ES without pupils that of the lids, see fapu.h.
/// - If a point is not seen, the mask of that frame lacks its FAPs.
///
/// The neutral face, if not given: frames with open eyes (lids at least 0.7 of the median opening)
/// and closed lips (gap in the lowest tenth between its 5th and 95th percentile), and of these the
/// half with the least motion of chin and lips. It faces the camera: its yaw and roll are removed
/// by the line through the eyes, its pitch is kept.
///
/// Values are rounded and clipped as in arkit_to_fap(). The same track gives the same clip.
///
/// Errors: invalid_argument (no frames, an invalid rate, unknown or duplicate points, frames of
/// different size, numbers that do not ascend, neutral frames that do not exist, smooth out of
/// range; units of a neutral face that are not positive; a `rest` without depth for a track with
/// depth), not_found (points that the units or the head need are missing or never seen; no frame is
/// neutral).
Result<LandmarkFace> landmarks_to_fap(const LandmarkTrack& track,
                                      const LandmarkOptions& options = {});

}  // namespace animeme::fap
