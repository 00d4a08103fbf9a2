#include "fap/detail/landmark_gaze.h"

#include <algorithm>
#include <cmath>

namespace animeme::fap::internal {
namespace {

constexpr double kEyeRadius = 0.18;  // of ES, see landmarks.h

std::optional<EyeAngles> by_direction(const Point& to) {
  const double flat = std::hypot(to[0], to[2]);
  if (!(std::hypot(flat, to[1]) > 0)) return std::nullopt;
  return EyeAngles{std::atan2(to[0], to[2]), std::atan2(-to[1], flat)};
}

}  // namespace

Gaze::Gaze(const LandmarkTrack& track, const TrackedFace& face, const NeutralFace& neutral,
           double es)
    : track_(track),
      neutral_(neutral),
      radius_(kEyeRadius * es),
      pupils_{face.find("3.5"), face.find("3.6")} {}

Eyes Gaze::eyes(std::size_t frame, const Rotation& head, const std::vector<Point>& still) const {
  Eyes out;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    if (const std::optional<Point>& gaze = track_.frames[frame].gaze[eye]) {
      out[eye] = by_direction(rotated(transposed(head), *gaze));
    } else if (pupils_[eye] >= 0) {
      const auto point = std::size_t(pupils_[eye]);
      out[eye] = by_pupil(still[point], neutral_.shape[point]);
    }
  }
  return out;
}

std::optional<EyeAngles> Gaze::by_pupil(const Point& at, const Point& rest) const {
  if (!is_seen(at) || !is_seen(rest)) return std::nullopt;
  const double pitch = std::asin(std::clamp((rest[1] - at[1]) / radius_, -1.0, 1.0));
  const double reach = radius_ * std::cos(pitch);
  const double side = reach > 0 ? (at[0] - rest[0]) / reach : 0;
  return EyeAngles{std::asin(std::clamp(side, -1.0, 1.0)), pitch};
}

}  // namespace animeme::fap::internal
