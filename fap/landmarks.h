/// @file
/// From tracked points of a face, as OpenFace, MediaPipe and the like find them in a video, to
/// FAPs.
///
///     animeme::fap::LandmarkTrack track{{30, 1}, {"2.1", "2.2", ...}, false, frames};
///     auto face = animeme::fap::landmarks_to_fap(track);
///     if (face) write(face->clip);
///
/// A FAP is how far a feature point has moved on the head, in units of the neutral face. So the
/// head is found in each frame (its place, size and turn), taken off, and what is left of the
/// distance to the neutral face is measured along the axis of the FAP: value = distance / FAPU *
/// 1024.
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

/// Beside those of kFeaturePoints: between the eyes, where the bone of the nose begins.
inline constexpr std::string_view kNasion = "nasion";

/// A feature point as a landmark of a tracker, or as the mean of two.
struct LandmarkSource {
  std::string_view point;  ///< id of kFeaturePoints, or kNasion
  int landmark = 0;        ///< number, from 0
  int second = -1;         ///< -1: there is no other
};

/// Sets of landmarks in common use. Numbers count from 0.
enum class LandmarkLayout : std::uint8_t {
  ibug68,     ///< 68 points of iBUG 300-W and Multi-PIE: OpenFace, dlib, face-alignment
  mediapipe,  ///< 468 points of MediaPipe Face Mesh; 468 and 473 are the irises if there are 478
};

/// Which landmarks give which feature points; landmark_maps.cpp has the grounds.
std::span<const LandmarkSource> landmark_sources(LandmarkLayout layout);

/// Angles of a head in rad as FAP 48, 49 and 50 have them: down, to the left, to the right are
/// positive; yaw is outermost, then pitch, then roll, as Greta turns heads (fap/semantics.md,
/// section 1).
struct HeadPose {
  double pitch = 0;  ///< rad, down
  double yaw = 0;    ///< rad, to the person's left
  double roll = 0;   ///< rad, to the person's right
};

/// One instant of a recording.
struct LandmarkFrame {
  std::int64_t number = 0;  ///< at the rate of the track; ascending
  /// Place of each point of the track; NaN: not seen. Without depth, z is ignored.
  std::vector<Point> at;
  /// Turn of the head against the camera, if the tracker tells. Used without depth only: with
  /// depth the points tell it.
  std::optional<HeadPose> head;
  /// Where the left and the right eye of the person look, any length: +X to the person's left, +Y
  /// up, +Z towards the camera. For eyes without one the pupils (3.5, 3.6) tell, if there.
  std::array<std::optional<Point>, 2> gaze;
};

/// A recording. Axes and lengths are those of the tracker: pixels, millimetres, anything whose x,
/// y (and z) have the same unit. Which way the axes go is told from the face: the eyes are above
/// the mouth, the left eye is on the left, the nose stands out. Points are those of the person:
/// the left eye of the person is on the right of a picture that is not mirrored.
struct LandmarkTrack {
  Rate rate;                          ///< of the recording
  std::vector<std::string> points;    ///< ids: kFeaturePoints or kNasion
  bool depth = false;                 ///< z is known
  std::vector<LandmarkFrame> frames;  ///< by ascending number
};

/// Where an eye looks, against the head, in rad.
struct EyeTurn {
  double yaw = 0;    ///< to the person's left
  double pitch = 0;  ///< down
};

/// A neutral face on its own, so that several recordings of a person are measured against one face
/// and in one set of units: each recording alone finds another one, and its units go with it.
struct RestingFace {
  bool depth = false;    ///< measured with depth; without, z is 0
  FeaturePoints points;  ///< upright and facing +Z; in units of the track it was measured in
  Fapu fapu;             ///< of these points, or told by others; all > 0
  HeadPose turn;         ///< of the head against the camera, at rest
  std::array<std::optional<EyeTurn>, 2> gaze;  ///< of the left and the right eye, at rest
};

/// What landmarks_to_fap() is told of a recording.
struct LandmarkOptions {
  /// Frames (their indices) of the neutral face: eyes open, mouth closed, looking at the camera.
  /// The medians of their points count. Empty: they are found, see landmarks_to_fap().
  std::vector<std::size_t> neutral;
  /// Width (standard deviation, seconds, 0..1) of the bell over time that values are averaged with;
  /// it looks both ways and delays nothing. 0: no smoothing. The default takes away jitter from one
  /// frame to the next at 50 or 60 frames a second, and next to nothing of speech: 91 % of a
  /// motion at 5 Hz, 73 % at 9 Hz.
  double smooth = 0.014;
  bool mirrored = false;  ///< the picture was mirrored, as selfie cameras do: swap left and right
  /// The neutral face, from another recording (LandmarkFace::rest); `neutral` is not used then. The
  /// size of the head in the picture may be another one. Of a track that has not enough points of
  /// the head (below), the head is taken to be off already, in place and size of this face.
  std::optional<RestingFace> rest;
};

/// What landmarks_to_fap() found.
struct LandmarkFace {
  Sequence clip;                             ///< frames of the track whose head was found
  Fapu fapu;                                 ///< in units of the track, at neutral
  std::vector<std::int64_t> neutral_frames;  ///< numbers of the frames that were taken, if any
  std::size_t lost = 0;                      ///< frames left out: too few points of the head seen
  /// Root mean square distance of the points that keep their place on the head from their place,
  /// as a share of ES: noise of the tracker, or a head that is measured wrongly.
  double head_error = 0;
  RestingFace rest = {};  ///< the neutral face that values were measured against, with `fapu`
};

/// FAPs of a recording.
///
/// - The head: a rotation, scale and shift for each frame from the points that keep their place on
///   it, whatever the face does: corners of the eyes (3.7, 3.8, 3.11, 3.12), the nose but its tip
///   and wings (9.6, 9.7, 9.12 to 9.15, nasion), hairline (11.1 to 11.3) and ears (10.7 to 10.10).
///   A point that is off counts less. Without depth the rotation is in the picture alone.
/// - FAP 48 to 50: turn of the head against that of the neutral face; with depth from the fit, else
///   from LandmarkFrame::head, else FAP 50 alone.
/// - FAPs of feature points, all that the track has but the pupils' size and the eyeballs' depth
///   (FAP 27 to 30); without depth, those along Z (14, 16, 17, 45) are left out.
///   A head that turns or nods then looks like a face that moves: a camera should see it from the
///   front, and head_error tells how far it did not.
/// - Eyeballs (FAP 23 to 26): turn of the gaze against the head and against the neutral gaze. By
///   pupils: the eyeball's radius is taken as 0.18 ES (11.5 mm at 63 mm between the pupils, means
///   of adults), an estimate.
/// - IRISD is the opening of the neutral lids; ES without pupils that of the lids, see fapu.h.
/// - A point that is not seen leaves its FAPs out of the mask of that frame.
///
/// The neutral face, if not given: frames with open eyes (lids at least 0.7 of the median opening)
/// and closed lips (gap in the lowest tenth between its 5th and 95th percentile), and of these the
/// calmer half, in which chin and lips move least. It faces the camera: its yaw and roll are taken
/// off by the line through the eyes, its pitch stays what it is.
///
/// Values are rounded and clipped as arkit_to_fap() does. The same track gives the same clip.
///
/// Errors: invalid_argument (no frames, an invalid rate, points that are unknown or twice there,
/// frames of another size, numbers that do not ascend, neutral frames that are not there, smooth
/// out of range; units of a neutral face that are not positive; a `rest` without depth for a track
/// with depth), not_found (points that the units
/// or the head need are missing or never seen; no frame is neutral).
Result<LandmarkFace> landmarks_to_fap(const LandmarkTrack& track,
                                      const LandmarkOptions& options = {});

}  // namespace animeme::fap
