/// @file
/// Interprets captured points as a face: which of them are feature points, the direction of the
/// face, its size. Key shapes can then be converted to FAPs, which every character supports: the
/// first guess for shapes that nobody has adjusted yet.
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

/// The feature points that are identified by names: ids ("8.1", "fp8.1"), or numbers of landmarks.
/// Numbers up to 67 only are those of iBUG, with larger ones those of MediaPipe, unless `layout` is
/// given.
std::vector<FacePoint> face_points(std::span<const std::string> names,
                                   std::optional<fap::LandmarkLayout> layout = std::nullopt);

/// Those of `points` that do not move with facial expressions: corners of the eyes, bridge of the
/// nose, hairline; indices of captured points.
std::vector<std::size_t> head_points(std::span<const FacePoint> points);

/// Those that speech moves: lips, chin, cheeks and tongue (groups 2, 5, 6, 8); indices. For all
/// points of iBUG and MediaPipe also the points between them on lips and chin.
std::vector<std::size_t> mouth_points(std::span<const std::string> names,
                                      std::span<const FacePoint> points,
                                      std::optional<fap::LandmarkLayout> layout = std::nullopt);

/// The pairs of inner lip points that meet in P, B and M: 2.2 with 2.3, 2.6 with 2.8, 2.7 with 2.9,
/// as far as present; indices.
std::vector<std::pair<std::size_t, std::size_t>> lip_contacts(std::span<const FacePoint> points);

/// Directions of x, y (and z) of captured points.
struct Axes {
  std::array<fap::Point, 3> of = {};  ///< unit vectors of left, up and forward in captured axes
};

/// Parses "left up forward", "left down back" (a camera's), in any of the words left, right, up,
/// down, forward (front), back, two for an image: the directions of x, y and z, from the person's
/// view. nullopt if the text is not such a list.
std::optional<Axes> parse_axes(std::string_view text);

/// Known properties of a face.
struct FaceOptions {
  std::optional<Axes> axes;  ///< nullopt: inferred from the points, see make_face()
  /// FAP units in units of the points; those that are 0 are measured or estimated.
  fap::Fapu fapu = {};
  /// Centimetres per unit of the points; 0: unknown. For estimates only.
  double centimetres = 0;
};

/// Captured points as a face.
struct Face {
  Axes axes;                              ///< its direction
  fap::Fapu fapu;                         ///< units of the points
  std::vector<int> faps;                  ///< those that its points determine, ascending
  std::vector<std::string> notes;         ///< sentences about what was estimated
  std::vector<std::vector<double>> rows;  ///< for each FAP: its value for 1 of each number of a
                                          ///< shape
};

/// `neutral`: the shape at rest, positions of all points of `names`.
///
/// - Left is the direction of the left points of pairs (corners of lips and eyes, sides of the
///   lips), up that of the upper ones (lips above chin, eyes and nose above lips); forward is
///   perpendicular to both, in a right-handed system. For an image, FAPs along forward are omitted.
/// - FAP units that are not given are measured on the points as in fap::measure_fapu(), each if its
///   points are present. Missing units are derived from the known ones by usual proportions
///   (ICT-FaceKit's: IRISD 0.993, ES 5.903, ENS 4.821, MNS 2.120, MW 5.070), or from the usual size
///   by `centimetres`; a note says so.
///
/// Errors: invalid_argument (negative units), not_found (no feature point; unknown direction of the
/// face; no known unit; each message names the remedy).
Result<Face> make_face(std::span<const std::string> names, std::size_t dimensions,
                       std::span<const double> neutral, std::span<const FacePoint> points,
                       const FaceOptions& options = {});

/// FAP values of a displacement, one for each of face.faps, not rounded; NaN if a required point is
/// NaN.
std::vector<double> fap_values(const Face& face, std::span<const double> displacement);

}  // namespace animeme::dam
