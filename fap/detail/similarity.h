// Rigid motions with a scale: where a head is, from points that keep their place on it. Internal.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "fap/fapu.h"
#include "fap/landmarks.h"

namespace animeme::fap::internal {

/// Rows of a rotation matrix.
using Rotation = std::array<Point, 3>;

inline constexpr Rotation kNoRotation = {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};

Point rotated(const Rotation& rotation, const Point& point);
Rotation transposed(const Rotation& rotation);
/// First `b`, then `a`.
Rotation product(const Rotation& a, const Rotation& b);
/// The rotation nearest to the sum of all (least squares); no rotation if there is none.
Rotation mean_rotation(std::span<const Rotation> rotations);
/// The smallest rotation that turns the direction of `from` to that of `to`.
Rotation shortest_rotation(const Point& from, const Point& to);

using HeadAngles = HeadPose;
Rotation rotation_of(const HeadAngles& angles);
HeadAngles angles_of(const Rotation& rotation);

/// to = scale * rotation * from + shift.
struct Similarity {
  Rotation rotation = kNoRotation;
  double scale = 1;
  Point shift{};
};
Point applied(const Similarity& pose, const Point& point);
Point taken_off(const Similarity& pose, const Point& point);

/// The weighted least squares fit (Horn 1987, unit quaternions); without `depth` only x and y
/// count and the rotation is about Z. Nothing if the points leave it open: fewer than two (flat) or
/// three, all in one place, or (with depth) all in one line.
std::optional<Similarity> fit_similarity(std::span<const Point> from, std::span<const Point> to,
                                         std::span<const double> weights, bool depth);

/// The same, but points that are off by much more than the others do not count: a tracker's slip
/// or a wrinkled nose does not move the head. Reweighted least squares, after Huber (less weight
/// from 2.5 times the median on), then after Tukey (none from 4 times the median on).
std::optional<Similarity> fit_robustly(std::span<const Point> from, std::span<const Point> to,
                                       bool depth);

}  // namespace animeme::fap::internal
