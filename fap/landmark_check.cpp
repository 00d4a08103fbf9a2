// Validates a recording of landmarks.
#include <algorithm>
#include <cmath>

#include "fap/detail/landmark_values.h"
#include "fap/tables.h"

namespace animeme::fap::internal {
namespace {

bool is_point(std::string_view id) {
  if (id == kNasion) return true;
  return std::any_of(kFeaturePoints.begin(), kFeaturePoints.end(),
                     [&](const FeaturePointInfo& point) { return point.id == id; });
}

Result<void> check_points(const std::vector<std::string>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_point(points[i])) {
      return make_error(Code::invalid_argument,
                        "'" + points[i] + "' is not a feature point (2.1 to 11.6)");
    }
    if (std::find(points.begin(), points.begin() + std::ptrdiff_t(i), points[i]) !=
        points.begin() + std::ptrdiff_t(i)) {
      return make_error(Code::invalid_argument,
                        "the feature point " + points[i] + " is there twice; remove one");
    }
  }
  return {};
}

Result<void> check_rest(const RestingFace& rest, const LandmarkTrack& track) {
  if (track.depth && !rest.depth) {
    return make_error(
        Code::invalid_argument,
        "the neutral face was measured without depth, this recording has depth; leave "
        "it out (--flat)");
  }
  for (const double unit :
       {rest.fapu.irisd, rest.fapu.es, rest.fapu.ens, rest.fapu.mns, rest.fapu.mw}) {
    if (unit > 0 && std::isfinite(unit)) continue;
    return make_error(Code::invalid_argument, "a unit of the neutral face is not positive");
  }
  return {};
}

}  // namespace

Result<void> check_landmarks(const LandmarkTrack& track, const LandmarkOptions& options) {
  if (auto ok = check_points(track.points); !ok) return ok;
  if (track.frames.empty()) {
    return make_error(Code::invalid_argument, "the recording has no frames");
  }
  if (!track.rate.valid()) return make_error(Code::invalid_argument, "the frame rate is not valid");
  if (!(options.smooth >= 0 && options.smooth <= 1)) {
    return make_error(Code::invalid_argument, "smooth must be 0 to 1 seconds");
  }
  for (std::size_t i = 0; i < track.frames.size(); ++i) {
    if (track.frames[i].at.size() != track.points.size()) {
      return make_error(Code::invalid_argument, "frame " + std::to_string(i) + " has " +
                                                    std::to_string(track.frames[i].at.size()) +
                                                    " points where the track has " +
                                                    std::to_string(track.points.size()));
    }
    if (i > 0 && track.frames[i].number <= track.frames[i - 1].number) {
      return make_error(Code::invalid_argument, "the frame numbers do not ascend");
    }
  }
  if (options.rest) return check_rest(*options.rest, track);
  for (const std::size_t frame : options.neutral) {
    if (frame >= track.frames.size()) {
      return make_error(Code::invalid_argument, "the neutral frame " + std::to_string(frame) +
                                                    " does not exist; the recording has " +
                                                    std::to_string(track.frames.size()));
    }
  }
  return {};
}

}  // namespace animeme::fap::internal
