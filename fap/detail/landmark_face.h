// A recording of landmarks by what it shows, and its neutral face. Internal.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "fap/detail/similarity.h"
#include "fap/landmarks.h"
#include "fap/result.h"

namespace animeme::fap::internal {

inline bool is_seen(const Point& point) {
  return point[0] == point[0] && point[1] == point[1] && point[2] == point[2];
}

double median_of(std::vector<double> values);

/// Points by frame, in axes that go the way of FAPs.
class TrackedFace {
 public:
  /// The track must be well formed. z is 0 without depth. `in_place`: the head is off already.
  explicit TrackedFace(const LandmarkTrack& track, bool in_place = false);

  std::size_t frames() const { return frames_.size(); }
  bool depth() const { return depth_; }
  const std::vector<Point>& at(std::size_t frame) const { return frames_[frame]; }
  /// Place of an id among the points, -1: the track has none.
  int find(std::string_view id) const;
  /// The point in a frame; nothing if it is not there or not seen.
  std::optional<Point> seen(std::size_t frame, std::string_view id) const;
  /// Distance of two points, nothing if one is not seen.
  std::optional<double> distance(std::size_t frame, std::string_view a, std::string_view b) const;

  /// Where the head is that keeps its points where `shape` has them; nothing if too few are seen.
  std::optional<Similarity> pose(const std::vector<Point>& shape, std::size_t frame) const;
  /// Points that keep their place on the head.
  const std::vector<std::size_t>& fixed() const { return fixed_; }

 private:
  void turn_axes();

  const std::vector<std::string>& ids_;
  bool depth_;
  bool in_place_;
  std::vector<std::vector<Point>> frames_;
  std::vector<std::size_t> fixed_;
};

/// Has a track the points of the head that TrackedFace::pose() needs, seen or not?
bool has_head(const LandmarkTrack& track);

/// The frames of a calm face with open eyes and closed lips, ascending; none: there is none.
std::vector<std::size_t> find_neutral_frames(const TrackedFace& face);

/// The face whose moves are 0.
struct NeutralFace {
  std::vector<Point> shape;  ///< as the points of the track; upright, facing +Z
};
/// The medians of the points over `frames` (not empty). Error: not_found if the head is not seen.
Result<NeutralFace> measure_neutral(const TrackedFace& face, std::span<const std::size_t> frames);

}  // namespace animeme::fap::internal
