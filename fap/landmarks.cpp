#include "fap/landmarks.h"

#include <algorithm>
#include <cmath>

#include "fap/detail/landmark_face.h"
#include "fap/detail/landmark_gaze.h"
#include "fap/detail/landmark_values.h"
#include "fap/detail/symmetry.h"

namespace animeme::fap {
namespace {

using internal::EyeAngles;
using internal::Eyes;
using internal::Gaze;
using internal::NeutralFace;
using internal::PointFap;
using internal::Rotation;
using internal::Similarity;
using internal::TrackedFace;
using internal::ValueFrame;

constexpr int kFirstOfEyes = 23, kLastOfEyes = 30;
constexpr int kPitch = 48, kYaw = 49, kRoll = 50;

bool is_point(std::string_view id) {
  if (id == kNasion) return true;
  return std::any_of(kFeaturePoints.begin(), kFeaturePoints.end(),
                     [&](const FeaturePointInfo& point) { return point.id == id; });
}

Result<void> check_points(const std::vector<std::string>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_point(points[i])) {
      return make_error(Code::invalid_argument,
                        "'" + points[i] + "' is no feature point; 2.1 to 11.6 are");
    }
    if (std::find(points.begin(), points.begin() + std::ptrdiff_t(i), points[i]) !=
        points.begin() + std::ptrdiff_t(i)) {
      return make_error(Code::invalid_argument,
                        "the feature point " + points[i] + " is there twice; remove one");
    }
  }
  return {};
}

Result<void> check(const LandmarkTrack& track, const LandmarkOptions& options) {
  if (auto ok = check_points(track.points); !ok) return ok;
  if (track.frames.empty()) {
    return make_error(Code::invalid_argument, "a recording without frames has no face");
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
  for (const std::size_t frame : options.neutral) {
    if (frame >= track.frames.size()) {
      return make_error(Code::invalid_argument, "the neutral frame " + std::to_string(frame) +
                                                    " is not there; the recording has " +
                                                    std::to_string(track.frames.size()));
    }
  }
  return {};
}

// What points alone tell: FAPs that shift a point.
std::vector<PointFap> point_faps(const LandmarkTrack& track) {
  std::vector<PointFap> faps;
  for (const FapInfo& fap : kFaps) {
    const Move move = move_of(fap.number);
    if (move.kind != MoveKind::translate) continue;
    if (fap.number >= kFirstOfEyes && fap.number <= kLastOfEyes) continue;
    const auto found = std::find(track.points.begin(), track.points.end(), fap.feature_point);
    if (found == track.points.end()) continue;
    for (std::size_t axis = 0; axis < (track.depth ? 3U : 2U); ++axis) {
      if (move.axis[axis] == 0) continue;
      faps.push_back(
          {fap.number, std::size_t(found - track.points.begin()), axis, move.axis[axis]});
    }
  }
  return faps;
}

// A frame before it is measured in FAPs.
struct Seen {
  std::size_t frame;
  std::vector<Point> still;  // the head taken off
  Rotation turn;             // of the head against the neutral one
  bool has_turn;             // beyond the roll
  Eyes eyes;
};

class Measurement {
 public:
  Measurement(const LandmarkTrack& track, const TrackedFace& face, const NeutralFace& neutral,
              const Fapu& fapu)
      : track_(track), face_(face), neutral_(neutral), fapu_(fapu), faps_(point_faps(track)) {}

  // The frames whose head is found; the squares of what the fit leaves are added up.
  std::vector<Seen> look() {
    const Gaze gaze(track_, face_, neutral_, fapu_.es);
    std::vector<Seen> all;
    for (std::size_t frame = 0; frame < face_.frames(); ++frame) {
      const std::optional<Similarity> pose = face_.pose(neutral_.shape, frame);
      if (!pose) continue;
      Seen seen{frame, {}, {}, face_.depth(), {}};
      for (const Point& point : face_.at(frame)) seen.still.push_back(taken_off(*pose, point));
      for (const std::size_t i : face_.fixed()) add_error(seen.still[i], neutral_.shape[i]);
      Rotation head = pose->rotation;
      if (const auto& told = track_.frames[frame].head; told && !face_.depth()) {
        head = internal::rotation_of(*told);
        seen.has_turn = true;
      }
      seen.eyes = gaze.eyes(frame, head, seen.still);
      seen.turn = head;
      all.push_back(std::move(seen));
    }
    return all;
  }

  ValueFrame measure(const Seen& seen, const Rotation& neutral_turn, const Eyes& neutral_eyes) {
    ValueFrame out;
    out.number = track_.frames[seen.frame].number;
    const auto set = [&](int fap, double amount) {
      if (!std::isfinite(amount)) return;
      out.mask.set(std::size_t(fap));
      out.value[std::size_t(fap)] = fap_value(fap, amount, fapu_);
    };
    for (const PointFap& fap : faps_) {
      const double moved = seen.still[fap.point][fap.axis] - neutral_.shape[fap.point][fap.axis];
      set(fap.fap, fap.sign * moved);
    }
    const auto head =
        internal::angles_of(internal::product(internal::transposed(neutral_turn), seen.turn));
    set(kRoll, head.roll);
    if (seen.has_turn) {
      set(kPitch, head.pitch);
      set(kYaw, head.yaw);
    }
    for (std::size_t eye = 0; eye < 2; ++eye) {
      if (!seen.eyes[eye]) continue;
      const EyeAngles rest = neutral_eyes[eye].value_or(EyeAngles{});
      set(23 + int(eye), seen.eyes[eye]->yaw - rest.yaw);
      set(25 + int(eye), seen.eyes[eye]->pitch - rest.pitch);
    }
    return out;
  }

  double error() const { return count_ == 0 ? 0 : std::sqrt(squares_ / double(count_)); }

 private:
  void add_error(const Point& a, const Point& b) {
    if (!internal::is_seen(a) || !internal::is_seen(b)) return;
    for (std::size_t k = 0; k < 3; ++k) squares_ += (a[k] - b[k]) * (a[k] - b[k]);
    ++count_;
  }

  const LandmarkTrack& track_;
  const TrackedFace& face_;
  const NeutralFace& neutral_;
  const Fapu& fapu_;
  std::vector<PointFap> faps_;
  double squares_ = 0;
  std::size_t count_ = 0;
};

// The mean turn of the head, and the median gaze, over the neutral frames.
struct NeutralPose {
  Rotation turn = internal::kNoRotation;
  Eyes eyes;
};

NeutralPose neutral_pose(const std::vector<Seen>& all, const std::vector<std::size_t>& frames) {
  NeutralPose pose;
  std::vector<Rotation> turns;
  for (std::size_t eye = 0; eye < 2; ++eye) {
    std::vector<double> yaw;
    std::vector<double> pitch;
    for (const Seen& seen : all) {
      if (!std::binary_search(frames.begin(), frames.end(), seen.frame)) continue;
      if (eye == 0) turns.push_back(seen.turn);
      if (!seen.eyes[eye]) continue;
      yaw.push_back(seen.eyes[eye]->yaw);
      pitch.push_back(seen.eyes[eye]->pitch);
    }
    if (yaw.empty()) continue;
    pose.eyes[eye] = {internal::median_of(std::move(yaw)), internal::median_of(std::move(pitch))};
  }
  pose.turn = internal::mean_rotation(turns);
  return pose;
}

Frame rounded(const ValueFrame& values, bool mirrored) {
  Frame frame;
  frame.number = values.number;
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (!values.mask[std::size_t(fap)]) continue;
    const auto image = mirrored ? internal::mirror_image(fap) : internal::MirrorImage{fap, 1};
    frame.set(image.fap,
              internal::coded_value(image.sign * values.value[std::size_t(fap)], image.fap));
  }
  return frame;
}

FeaturePoints named(const std::vector<std::string>& ids, const std::vector<Point>& shape) {
  FeaturePoints points;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (internal::is_seen(shape[i])) points[ids[i]] = shape[i];
  }
  return points;
}

}  // namespace

Result<LandmarkFace> landmarks_to_fap(const LandmarkTrack& track, const LandmarkOptions& options) {
  if (auto ok = check(track, options); !ok) return ok.error();
  const TrackedFace tracked(track);
  std::vector<std::size_t> frames = options.neutral;
  std::sort(frames.begin(), frames.end());
  if (frames.empty()) frames = find_neutral_frames(tracked);
  if (frames.empty()) {
    return make_error(Code::not_found,
                      "no frame shows open eyes and closed lips (3.1, 3.3, 2.2, 2.3, 8.3, 8.4 and "
                      "the corners of the eyes tell); say which one is neutral");
  }
  const Result<NeutralFace> neutral = measure_neutral(tracked, frames);
  if (!neutral) return neutral.error();
  const Result<Fapu> fapu = measure_fapu(named(track.points, neutral->shape));
  if (!fapu) return fapu.error();

  Measurement measurement(track, tracked, *neutral, *fapu);
  const std::vector<Seen> all = measurement.look();
  const NeutralPose pose = neutral_pose(all, frames);
  std::vector<ValueFrame> values;
  for (const Seen& seen : all) values.push_back(measurement.measure(seen, pose.turn, pose.eyes));
  values = internal::smoothed(values, track.rate, options.smooth);

  LandmarkFace face{{track.rate, {}, {}},
                    *fapu,
                    {},
                    track.frames.size() - all.size(),
                    measurement.error() / fapu->es};
  for (const ValueFrame& one : values) face.clip.frames.push_back(rounded(one, options.mirrored));
  for (const std::size_t frame : frames) {
    face.neutral_frames.push_back(track.frames[frame].number);
  }
  return face;
}

}  // namespace animeme::fap
