#include "fap/landmarks.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

// FAPs that follow from points alone: those that shift a point.
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
              const Fapu& fapu, bool in_place)
      : track_(track),
        face_(face),
        neutral_(neutral),
        fapu_(fapu),
        faps_(point_faps(track)),
        in_place_(in_place) {}

  // The frames whose head is found; the squares of what the fit leaves are added up.
  std::vector<Seen> look() {
    const Gaze gaze(track_, face_, neutral_, fapu_.es);
    std::vector<Seen> all;
    for (std::size_t frame = 0; frame < face_.frames(); ++frame) {
      const std::optional<Similarity> pose = face_.pose(neutral_.shape, frame);
      if (!pose) continue;
      Seen seen{frame, {}, {}, face_.depth() && !in_place_, {}};
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
    if (!in_place_ || seen.has_turn) set(kRoll, head.roll);
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
  bool in_place_;
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

// The neutral face of a recording, and what it says of turn and gaze.
struct Neutral {
  NeutralFace shape;
  Fapu fapu;
  std::vector<std::size_t> frames;  // none: LandmarkOptions::rest is used
};

Result<Neutral> neutral_of(const LandmarkTrack& track, const TrackedFace& tracked,
                           const LandmarkOptions& options) {
  Neutral neutral;
  if (options.rest) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    for (const std::string& id : track.points) {
      const auto found = options.rest->points.find(id);
      Point place = {kUnknown, kUnknown, kUnknown};
      if (found != options.rest->points.end()) place = found->second;
      if (!track.depth && internal::is_seen(place)) place[2] = 0;
      neutral.shape.shape.push_back(place);
    }
    neutral.fapu = options.rest->fapu;
    return neutral;
  }
  neutral.frames = options.neutral;
  std::sort(neutral.frames.begin(), neutral.frames.end());
  if (neutral.frames.empty()) neutral.frames = find_neutral_frames(tracked);
  if (neutral.frames.empty()) {
    return make_error(Code::not_found,
                      "no frame has open eyes and closed lips (by 3.1, 3.3, 2.2, 2.3, 8.3, 8.4 and "
                      "the corners of the eyes); specify a neutral frame");
  }
  Result<NeutralFace> shape = measure_neutral(tracked, neutral.frames);
  if (!shape) return std::move(shape).error();
  neutral.shape = std::move(*shape);
  const Result<Fapu> fapu = measure_fapu(named(track.points, neutral.shape.shape));
  if (!fapu) return fapu.error();
  neutral.fapu = *fapu;
  return neutral;
}

RestingFace resting_face(const LandmarkTrack& track, const Neutral& neutral,
                         const NeutralPose& pose) {
  return {track.depth, named(track.points, neutral.shape.shape), neutral.fapu,
          internal::angles_of(pose.turn), pose.eyes};
}

}  // namespace

Result<LandmarkFace> landmarks_to_fap(const LandmarkTrack& track, const LandmarkOptions& options) {
  if (auto ok = internal::check_landmarks(track, options); !ok) return ok.error();
  const bool in_place = options.rest && !internal::has_head(track);
  const TrackedFace tracked(track, in_place);
  Result<Neutral> neutral = neutral_of(track, tracked, options);
  if (!neutral) return std::move(neutral).error();

  Measurement measurement(track, tracked, neutral->shape, neutral->fapu, in_place);
  const std::vector<Seen> all = measurement.look();
  NeutralPose pose;
  if (options.rest) {
    pose = {internal::rotation_of(options.rest->turn), options.rest->gaze};
  } else {
    pose = neutral_pose(all, neutral->frames);
  }
  std::vector<ValueFrame> values;
  for (const Seen& seen : all) values.push_back(measurement.measure(seen, pose.turn, pose.eyes));
  values = internal::smoothed(values, track.rate, options.smooth);

  LandmarkFace face{{track.rate, {}, {}},
                    neutral->fapu,
                    {},
                    track.frames.size() - all.size(),
                    measurement.error() / neutral->fapu.es,
                    options.rest ? *options.rest : resting_face(track, *neutral, pose)};
  for (const ValueFrame& one : values) face.clip.frames.push_back(rounded(one, options.mirrored));
  for (const std::size_t frame : neutral->frames) {
    face.neutral_frames.push_back(track.frames[frame].number);
  }
  return face;
}

}  // namespace animeme::fap
