/// @file
/// Captured points as points of a face: which of them are feature points, which way the face looks,
/// how large it is. So a key shape becomes FAPs, which every character understands: the first guess
/// for shapes that nobody has adjusted yet.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dam/crossmap/points.h"
#include "fap/fapu.h"
#include "fap/landmarks.h"
#include "fap/result.h"

namespace animeme::dam {

/// A feature point as the mean of captured points.
struct FacePoint {
  std::string id;                   ///< of fap::kFeaturePoints, or fap::kNasion
  std::vector<std::size_t> points;  ///< indices of captured points, one or more
};

/// The feature points that names tell: ids ("8.1", "fp8.1"), or numbers of landmarks. Numbers up to
/// 67 alone are those of iBUG, with larger ones those of MediaPipe, unless `layout` says.
std::vector<FacePoint> face_points(std::span<const std::string> names,
                                   std::optional<fap::LandmarkLayout> layout = std::nullopt);

/// Those of `points` that keep their place on the head, whatever the face does: corners of the
/// eyes, bridge of the nose, hairline; indices of captured points.
std::vector<std::size_t> head_points(std::span<const FacePoint> points);

/// Those that speech moves: lips, chin, cheeks and tongue (groups 2, 5, 6, 8); indices. For all
/// points of iBUG and MediaPipe also the points between them on lips and chin.
std::vector<std::size_t> mouth_points(std::span<const std::string> names,
                                      std::span<const FacePoint> points,
                                      std::optional<fap::LandmarkLayout> layout = std::nullopt);

/// The pairs of inner lip points that meet in P, B and M: 2.2 with 2.3, 2.6 with 2.8, 2.7 with 2.9,
/// as far as they are there; indices.
std::vector<std::pair<std::size_t, std::size_t>> lip_contacts(std::span<const FacePoint> points);

/// Where x, y (and z) of captured points go: signs and axes of the face, 0 +X (left), 1 +Y (up), 2
/// +Z (forward).
struct Axes {
  std::array<fap::Point, 3> of = {};  ///< unit vectors of left, up and forward in captured axes
};

/// "left up forward", "left down back" (a camera's), in any of the words left, right, up, down,
/// forward (front), back, two for a picture: where x, y and z point to, seen by the person. Nothing
/// if it is no such list.
std::optional<Axes> parse_axes(std::string_view text);

/// What is known of a face beside its points.
struct FaceOptions {
  std::optional<Axes> axes;  ///< nothing: told from the points, see make_face()
  /// FAP units in units of the points; those that are 0 are measured or estimated.
  fap::Fapu fapu = {};
  /// Centimetres of one unit of the points; 0: not known. For estimates alone.
  double centimetres = 0;
};

/// Captured points as a face.
struct Face {
  Axes axes;                              ///< which way it looks
  fap::Fapu fapu;                         ///< units of the points
  std::vector<int> faps;                  ///< those that its points tell, ascending
  std::vector<std::string> notes;         ///< sentences for people: what was estimated
  std::vector<std::vector<double>> rows;  ///< for each FAP: its value for 1 of each number of a
                                          ///< shape
};

/// `neutral`: the shape at rest, places of all points of `names`.
///
/// - Left is where the left points of pairs lie (corners of lips and eyes, sides of the lips), up
///   where the upper ones do (lips over chin, eyes and nose over lips); forward is square to both
///   as in a right-handed system. In a picture FAPs along forward are left out.
/// - FAP units that are not given are measured on the points as fap::measure_fapu() does, each as
///   far as its points are there. What is missing then has the usual proportion to what is known
///   (ICT-FaceKit's: IRISD 0.993, ES 5.903, ENS 4.821, MNS 2.120, MW 5.070), or the usual size by
///   `centimetres`; a note says so.
///
/// Errors: invalid_argument (units that are negative), not_found (no feature point; which way the
/// face looks cannot be told; no unit is known; each names the remedy).
Result<Face> make_face(std::span<const std::string> names, std::size_t dimensions,
                       std::span<const double> neutral, std::span<const FacePoint> points,
                       const FaceOptions& options = {});

/// FAP values of a displacement, one for each of face.faps, not rounded; NaN where a point that it
/// needs is NaN.
std::vector<double> fap_values(const Face& face, std::span<const double> displacement);

}  // namespace animeme::dam
