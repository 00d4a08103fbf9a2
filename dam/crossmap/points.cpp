#include "dam/crossmap/points.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "fap/detail/similarity.h"

namespace animeme::dam {
namespace {

constexpr double kNotSeen = std::numeric_limits<double>::quiet_NaN();

Error of_track(const PointTrack& track, const std::string& what) {
  return make_error(Code::invalid_argument,
                    (track.name.empty() ? "the recording" : track.name) + " " + what);
}

// The sum of squared steps to the next frame; infinite if a point is not seen in both.
double step_of(const PointTrack& track, std::size_t frame) {
  const auto now = track.frame(frame), next = track.frame(frame + 1);
  double sum = 0;
  for (std::size_t k = 0; k < now.size(); ++k) sum += (next[k] - now[k]) * (next[k] - now[k]);
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

// A point of a shape; z is 0 in a picture.
fap::Point place_of(std::span<const double> shape, std::size_t point, std::size_t dimensions) {
  fap::Point place{};
  for (std::size_t k = 0; k < dimensions; ++k) place[k] = shape[point * dimensions + k];
  return place;
}

// How to move a shape so that `points` lie where they lie in `neutral`; nothing if they leave it
// open.
std::optional<fap::internal::Similarity> move_to(std::span<const double> neutral,
                                                 std::span<const double> shape,
                                                 std::span<const std::size_t> points,
                                                 std::size_t dimensions) {
  std::vector<fap::Point> from, to;
  for (const std::size_t point : points) {
    from.push_back(place_of(shape, point, dimensions));
    to.push_back(place_of(neutral, point, dimensions));
  }
  const std::vector<double> weights(points.size(), 1.0);
  auto move = fap::internal::fit_similarity(from, to, weights, dimensions == 3);
  if (!move || dimensions == 2) return move;
  // In space a head keeps its size: the same rotation about the centre of the points.
  fap::Point from_sum{}, to_sum{};
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      from_sum[k] += from[i][k];
      to_sum[k] += to[i][k];
    }
  }
  const fap::Point turned = fap::internal::rotated(move->rotation, from_sum);
  move->scale = 1;
  for (std::size_t k = 0; k < 3; ++k)
    move->shift[k] = (to_sum[k] - turned[k]) / double(from.size());
  return move;
}

}  // namespace

Result<void> check_tracks(std::span<const PointTrack> tracks) {
  if (tracks.empty()) return make_error(Code::invalid_argument, "there is no recording of points");
  const PointTrack& first = tracks.front();
  for (const PointTrack& track : tracks) {
    if (track.dimensions != 2 && track.dimensions != 3) {
      return of_track(track, "has points of neither two nor three dimensions");
    }
    if (!track.rate.valid()) return of_track(track, "has no frame rate");
    if (track.frames() == 0) return of_track(track, "has no frames");
    if (track.values.size() != track.frames() * track.size()) {
      return of_track(track, "ends in the middle of a frame");
    }
    if (track.dimensions != first.dimensions) {
      return of_track(track, "has points of " + std::to_string(track.dimensions) +
                                 " dimensions, the first recording of " +
                                 std::to_string(first.dimensions));
    }
    if (track.names != first.names) {
      return of_track(track, "has other points than the first recording, or another order of them");
    }
  }
  return {};
}

PointTrack with_points(const PointTrack& track, std::span<const std::size_t> points) {
  PointTrack out{track.name, track.rate, track.dimensions, {}, {}};
  for (const std::size_t point : points) out.names.push_back(track.names[point]);
  out.values.reserve(track.frames() * out.size());
  for (std::size_t i = 0; i < track.frames(); ++i) {
    const auto shape = track.frame(i);
    for (const std::size_t point : points) {
      const auto from = shape.begin() + std::ptrdiff_t(point * track.dimensions);
      out.values.insert(out.values.end(), from, from + std::ptrdiff_t(track.dimensions));
    }
  }
  return out;
}

std::vector<double> median_shape(const PointTrack& track, std::size_t first, std::size_t last) {
  std::vector<double> shape, seen;
  for (std::size_t k = 0; k < track.size(); ++k) {
    seen.clear();
    for (std::size_t i = first; i <= last && i < track.frames(); ++i) {
      if (std::isfinite(track.frame(i)[k])) seen.push_back(track.frame(i)[k]);
    }
    if (seen.empty()) {
      shape.push_back(kNotSeen);
      continue;
    }
    const auto middle = seen.begin() + std::ptrdiff_t(seen.size() / 2);
    std::nth_element(seen.begin(), middle, seen.end());
    shape.push_back(*middle);
  }
  return shape;
}

Result<std::vector<double>> resting_shape(std::span<const PointTrack> tracks, double seconds) {
  if (auto ok = check_tracks(tracks); !ok) return ok.error();
  double least = std::numeric_limits<double>::infinity();
  const PointTrack* stillest = nullptr;
  std::size_t begin = 0, length = 0;
  for (const PointTrack& track : tracks) {
    const double rate = track.rate.frames_per_second();
    const auto steps = std::max<std::size_t>(1, std::size_t(std::llround(seconds * rate)));
    // Means over the same time can be compared, whatever the rate: steps grow with its inverse.
    for (std::size_t i = 0; i + steps < track.frames(); ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < steps && sum < least; ++k) {
        sum += step_of(track, i + k) * rate * rate / double(steps);
      }
      if (!(sum < least)) continue;
      least = sum;
      stillest = &track;
      begin = i;
      length = steps;
    }
  }
  if (stillest == nullptr) {
    return make_error(Code::not_found,
                      "there is no stretch in which all points are seen, so that the neutral shape "
                      "cannot be found; give it");
  }
  return median_shape(*stillest, begin, begin + length);
}

Result<std::size_t> hold_head_still(PointTrack& track, std::span<const std::size_t> head,
                                    std::span<const double> neutral) {
  const std::size_t dimensions = track.dimensions, needed = dimensions == 3 ? 3 : 2;
  if (head.size() < needed) {
    return make_error(Code::invalid_argument,
                      "the head wants " + std::string(needed == 3 ? "three" : "two") +
                          " points at least that do not move with the face");
  }
  for (const std::size_t point : head) {
    if (point >= track.names.size()) {
      return make_error(Code::invalid_argument, "the head has an invalid point");
    }
    for (std::size_t k = 0; k < dimensions; ++k) {
      if (std::isfinite(neutral[point * dimensions + k])) continue;
      return make_error(
          Code::invalid_argument,
          "the point " + track.names[point] + " of the head is not seen in the neutral shape");
    }
  }
  std::size_t lost = 0;
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < track.frames(); ++i) {
    seen.clear();
    for (const std::size_t point : head) {
      if (track.seen(i, point)) seen.push_back(point);
    }
    const auto shape = track.frame(i);
    const auto move = move_to(neutral, shape, seen, dimensions);
    if (!move) {
      std::fill(shape.begin(), shape.end(), kNotSeen);
      ++lost;
      continue;
    }
    for (std::size_t point = 0; point < track.names.size(); ++point) {
      const fap::Point place = fap::internal::applied(*move, place_of(shape, point, dimensions));
      std::copy_n(place.begin(), dimensions, &shape[point * dimensions]);
    }
  }
  return lost;
}

void subtract(PointTrack& track, std::span<const double> neutral) {
  for (std::size_t i = 0; i < track.frames(); ++i) {
    const auto shape = track.frame(i);
    for (std::size_t k = 0; k < shape.size(); ++k) shape[k] -= neutral[k];
  }
}

}  // namespace animeme::dam
