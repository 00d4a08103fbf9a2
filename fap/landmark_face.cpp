// Axes, head pose and neutral face of a recording of landmarks.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fap/detail/landmark_face.h"

namespace animeme::fap::internal {
namespace {

constexpr double kNotSeen = std::numeric_limits<double>::quiet_NaN();

// What no FAP moves and no other point drags along.
constexpr std::string_view kFixed[] = {"3.7",  "3.8",  "3.11", "3.12", "9.6",   "9.7",
                                       "9.12", "9.13", "9.14", "9.15", kNasion, "11.1",
                                       "11.2", "11.3", "10.7", "10.8", "10.9",  "10.10"};

struct Opposite {
  std::string_view plus;
  std::string_view minus;
};
constexpr Opposite kLeftRight[] = {{"3.7", "3.12"}, {"3.11", "3.8"}, {"3.1", "3.2"},
                                   {"3.3", "3.4"},  {"3.5", "3.6"},  {"4.5", "4.6"},
                                   {"8.3", "8.4"},  {"2.4", "2.5"},  {"5.1", "5.2"}};
constexpr Opposite kUpDown[] = {{"3.7", "8.3"}, {"3.12", "8.4"}, {"3.1", "8.1"},
                                {"3.3", "2.2"}, {"3.4", "2.3"},  {kNasion, "9.15"}};
// Of a track that has the mouth alone: the lips, and how their middle stands out before the
// corners.
constexpr Opposite kUpDownOfMouth[] = {{"8.1", "8.2"}, {"2.2", "2.1"}, {"8.1", "2.1"}};
constexpr Opposite kFrontBackOfMouth[] = {{"8.1", "8.3"}, {"8.1", "8.4"}};
constexpr Opposite kFrontBack[] = {{"9.3", "3.7"}, {"9.3", "3.12"}, {"9.3", "3.11"},
                                   {"9.3", "3.8"}, {"9.3", "3.1"},  {"9.3", "3.2"}};

// -1 if the axis goes the other way: the median over the frames decides; of a track that has none
// of the pairs, the `others`.
double direction(const TrackedFace& face, std::span<const Opposite> pairs, std::size_t axis,
                 std::span<const Opposite> others = {}) {
  std::vector<double> differences;
  for (std::size_t frame = 0; frame < face.frames(); ++frame) {
    for (const Opposite& pair : pairs) {
      const auto a = face.seen(frame, pair.plus);
      const auto b = face.seen(frame, pair.minus);
      if (a && b) differences.push_back((*a)[axis] - (*b)[axis]);
    }
  }
  if (differences.empty()) return others.empty() ? 1 : direction(face, others, axis);
  return median_of(std::move(differences)) < 0 ? -1 : 1;
}

Point median_point(const std::vector<Point>& points) {
  if (points.empty()) return {kNotSeen, kNotSeen, kNotSeen};
  Point out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Point& point : points) values.push_back(point[axis]);
    out[axis] = median_of(std::move(values));
  }
  return out;
}

// From the right to the left of the face.
Point eye_line(const TrackedFace& face, const std::vector<Point>& shape) {
  Point sum{};
  for (const Opposite& pair : std::span(kLeftRight).first(5)) {
    const int a = face.find(pair.plus);
    const int b = face.find(pair.minus);
    if (a < 0 || b < 0 || !is_seen(shape[std::size_t(a)]) || !is_seen(shape[std::size_t(b)])) {
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += shape[std::size_t(a)][k] - shape[std::size_t(b)][k];
    }
  }
  return sum;
}

}  // namespace

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

bool has_head(const LandmarkTrack& track) {
  const auto fixed = [](const std::string& id) {
    return std::find(std::begin(kFixed), std::end(kFixed), id) != std::end(kFixed);
  };
  const auto count = std::count_if(track.points.begin(), track.points.end(), fixed);
  return count >= (track.depth ? 3 : 2);
}

TrackedFace::TrackedFace(const LandmarkTrack& track, bool in_place)
    : ids_(track.points), depth_(track.depth), in_place_(in_place) {
  for (const LandmarkFrame& frame : track.frames) {
    frames_.push_back(frame.at);
    for (Point& point : frames_.back()) {
      if (!depth_) point[2] = 0;
      if (!std::isfinite(point[0] + point[1] + point[2])) point = {kNotSeen, kNotSeen, kNotSeen};
    }
  }
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (std::find(std::begin(kFixed), std::end(kFixed), ids_[i]) != std::end(kFixed)) {
      fixed_.push_back(i);
    }
  }
  turn_axes();
}

void TrackedFace::turn_axes() {
  const Point sign = {direction(*this, kLeftRight, 0), direction(*this, kUpDown, 1, kUpDownOfMouth),
                      depth_ ? direction(*this, kFrontBack, 2, kFrontBackOfMouth) : 1};
  for (std::vector<Point>& points : frames_) {
    for (Point& point : points) {
      for (std::size_t k = 0; k < 3; ++k) point[k] *= sign[k];
    }
  }
}

int TrackedFace::find(std::string_view id) const {
  const auto found = std::find(ids_.begin(), ids_.end(), id);
  return found == ids_.end() ? -1 : int(found - ids_.begin());
}

std::optional<Point> TrackedFace::seen(std::size_t frame, std::string_view id) const {
  const int index = find(id);
  if (index < 0 || !is_seen(frames_[frame][std::size_t(index)])) return std::nullopt;
  return frames_[frame][std::size_t(index)];
}

std::optional<double> TrackedFace::distance(std::size_t frame, std::string_view a,
                                            std::string_view b) const {
  const auto from = seen(frame, a);
  const auto to = seen(frame, b);
  if (!from || !to) return std::nullopt;
  return std::hypot((*to)[0] - (*from)[0], (*to)[1] - (*from)[1], (*to)[2] - (*from)[2]);
}

std::optional<Similarity> TrackedFace::pose(const std::vector<Point>& shape,
                                            std::size_t frame) const {
  if (in_place_) return Similarity{};
  std::vector<Point> from;
  std::vector<Point> to;
  for (const std::size_t i : fixed_) {
    if (!is_seen(shape[i]) || !is_seen(frames_[frame][i])) continue;
    from.push_back(shape[i]);
    to.push_back(frames_[frame][i]);
  }
  return fit_robustly(from, to, depth_);
}

Result<NeutralFace> measure_neutral(const TrackedFace& face, std::span<const std::size_t> frames) {
  const std::vector<Point>& first = face.at(frames.front());
  std::vector<std::vector<Point>> places(first.size());
  std::vector<Rotation> turns;
  for (const std::size_t frame : frames) {
    const std::optional<Similarity> pose = face.pose(first, frame);
    if (!pose) continue;
    turns.push_back(pose->rotation);
    for (std::size_t i = 0; i < first.size(); ++i) {
      const Point& point = face.at(frame)[i];
      if (is_seen(point)) places[i].push_back(taken_off(*pose, point));
    }
  }
  if (turns.empty()) {
    return make_error(
        Code::not_found,
        std::string("the head cannot be found in the neutral frame: ") +
            (face.depth() ? "three points that are not in a line" : "two points") +
            " of the corners of the eyes (3.7, 3.8, 3.11, 3.12), the ridge and base of the nose "
            "(9.12, 9.15) or the hairline (11.1) are needed");
  }
  // As the camera sees the head on average, then without its yaw and roll.
  const Rotation seen = mean_rotation(turns);
  NeutralFace neutral;
  for (const std::vector<Point>& place : places) {
    neutral.shape.push_back(rotated(seen, median_point(place)));
  }
  const Point line = eye_line(face, neutral.shape);
  const Rotation upright = shortest_rotation(line, {1, 0, 0});
  for (Point& point : neutral.shape) point = rotated(upright, point);
  return neutral;
}

}  // namespace animeme::fap::internal
