#include <algorithm>
#include <array>
#include <cmath>

#include "fap/arkit.h"
#include "fap/detail/lips.h"
#include "fap/expand.h"
#include "fap/head/detail/normals.h"
#include "fap/head/detail/stops.h"
#include "fap/head/detail/targets.h"
#include "fap/head/detail/whole.h"
#include "fap/head/rig.h"
#include "fap/head/shapes.h"
#include "fap/shape_fit.h"
#include "fap/tables.h"
#include "fap/viseme.h"
#include "fap/wider.h"

namespace animeme::head {
namespace {

using Values = ControlValues;

std::size_t index(Part part) { return std::size_t(part); }

bool is_lid(int control) { return control >= 19 && control <= 22; }

// Lids only, or everything but the lids.
void apply_targets(const Rig& rig, const Values& values, bool lids, Pose& out) {
  for (const Target& target : rig.targets) {
    const float value = target.units(values[std::size_t(target.control)]);
    if (value == 0 || is_lid(target.control) != lids) continue;
    Vec3* places = out.positions[index(target.part)].data();
    const std::uint32_t* vertices = target.vertices.data();
    const Vec3* deltas = target.deltas.data();
    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
      places[vertices[k]] += deltas[k] * value;
    }
  }
}

// Puts the skin of the lids back to its distance from the centre of the eye, so that it slides.
void slide_lids(const Rig& rig, std::vector<Vec3>& skin) {
  const auto& neutral = rig.parts[index(Part::skin)].positions;
  for (std::size_t side = 0; side < 2; ++side) {
    const Vec3 centre = rig.eyes[side].centre;
    for (const std::uint32_t v : rig.lid_vertices[side]) {
      if (skin[v] == neutral[v]) continue;
      const Vec3 was = neutral[v] - centre;
      const Vec3 is = skin[v] - centre;
      const float square = dot(was, was) - is.x * is.x - is.y * is.y;
      const float slid = std::sqrt(std::max(square, 0.04f * dot(was, was)));
      // Not at the sides of the eye nor far from it, where it would push skin to the front.
      const float size = length(was);
      const float share = smooth_step(0.15f, 0.4f, was.z / size) *
                          smooth_step(2.0f, 1.4f, size / rig.eyes[side].radius);
      skin[v].z += (slid - is.z) * share;
    }
  }
}

// Skin that other FAPs have pushed into an eyeball comes out again.
void keep_off_eyes(const Rig& rig, const Values& values, std::vector<Vec3>& skin) {
  const auto& neutral = rig.parts[index(Part::skin)].positions;
  for (std::size_t side = 0; side < 2; ++side) {
    const Eye& eye = rig.eyes[side];
    const Vec3 forward{0, 0, values[27 + side] * float(rig.fapu.es) / 1024};
    for (const std::uint32_t v : rig.eye_skin[side]) {
      const Vec3 d = skin[v] - eye.centre - forward;
      const float least = std::min(1.07f * eye.radius, length(neutral[v] - eye.centre));
      const float distance = length(d);
      if (distance < least && distance > 0) skin[v] += d * (least / distance - 1);
    }
  }
}

// Pairs that have passed each other meet in the middle, and so do those that nearly touch: lips and
// lids are soft.
void close_pairs(const std::vector<ContactPair>& pairs, float soft, std::vector<Vec3>& skin) {
  for (const ContactPair& pair : pairs) {
    Vec3& upper = skin[pair.upper];
    Vec3& lower = skin[pair.lower];
    const float touch = smooth_step(soft, soft / 3, upper.y - lower.y) * 0.5f;
    const Vec3 apart = lower - upper;
    upper += apart * touch;
    lower -= apart * touch;
  }
}

// Lashes turn with the rim that carries them, about the centre of the eye.
void turn_lashes(const Rig& rig, const std::vector<Vec3>& skin, std::vector<Vec3>& lashes) {
  const auto& neutral_skin = rig.parts[index(Part::skin)].positions;
  const auto& neutral = rig.parts[index(Part::lashes)].positions;
  if (rig.lash_anchors.empty()) return;
  lashes = neutral;
  for (std::size_t i = 0; i < neutral.size(); ++i) {
    const std::uint32_t anchor = rig.lash_anchors[i];
    if (skin[anchor] == neutral_skin[anchor]) continue;
    const Vec3 centre = rig.eyes[neutral[i].x > 0 ? 0 : 1].centre;
    const Vec3 was = neutral_skin[anchor] - centre;
    const Vec3 is = skin[anchor] - centre;
    // The turn about X that brings the anchor from its old height to its new one.
    const float size = std::sqrt((was.y * was.y + was.z * was.z) * (is.y * is.y + is.z * is.z));
    if (size <= 0) continue;
    const float c = (was.y * is.y + was.z * is.z) / size;
    const float s = (was.y * is.z - was.z * is.y) / size;
    const Vec3 offset = neutral[i] - neutral_skin[anchor];
    lashes[i] =
        skin[anchor] + Vec3{offset.x, c * offset.y - s * offset.z, s * offset.y + c * offset.z};
  }
}

void turn_neck(const Rig& rig, const Transform& head, std::vector<Vec3>& skin) {
  if (head == Transform{}) return;
  for (std::size_t v = 0; v < skin.size(); ++v) {
    skin[v] = mix(skin[v], head(skin[v]), rig.neck_weights[v]);
  }
}

Transform eye_transform(const Rig& rig, std::size_t side, const Values& v) {
  constexpr float kRad = 1e-5f;
  Transform turn =
      rotation_about(rig.eyes[side].centre, v[25 + side] * kRad, v[23 + side] * kRad, 0);
  turn.shift.z += v[27 + side] * float(rig.fapu.es) / 1024;
  return turn;
}

void set_transforms(const Rig& rig, const Values& v, Pose& out) {
  constexpr float kRad = 1e-5f;
  out.head = rotation_about(rig.neck_pivot, v[48] * kRad, v[49] * kRad, v[50] * kRad);
  out.jaw = detail::jaw_transform(rig, v[3], v[14], v[15]);
  const bool straight = v[48] == 0 && v[49] == 0 && v[50] == 0;
  if (straight) out.head = {};
  for (const Part part : {Part::upper_teeth, Part::hair, Part::brows, Part::lashes}) {
    out.transforms[index(part)] = out.head;
  }
  for (const Part part : {Part::lower_teeth, Part::tongue}) {
    out.transforms[index(part)] = compose(out.head, out.jaw);
  }
  out.transforms[index(Part::left_eye)] = compose(out.head, eye_transform(rig, 0, v));
  out.transforms[index(Part::right_eye)] = compose(out.head, eye_transform(rig, 1, v));
  for (const Part part : {Part::lower_teeth, Part::tongue, Part::left_eye, Part::right_eye}) {
    if (rig.shown_by_shapes[index(part)]) out.transforms[index(part)] = out.head;
  }
  out.transforms[index(Part::skin)] = {};
  out.transforms[index(Part::body)] = {};
}

// What shapes should show: absent FAPs are 0, else a sneer would be taken for the help that it is
// to the lips. But the chin's own FAPs (thrust, boss) are 0 in most clips because nobody measured
// them; an opened jaw takes the chin along, and should not be kept from it. So it is with cheeks
// where lips that round take them along.
fap::Frame wanted_of_shapes(fap::Frame frame, bool cheeks_follow) {
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    if (!frame.mask[std::size_t(f)]) frame.set(f, 0);
  }
  for (const std::size_t f : {14, 18, 39, 40}) {
    if (frame.value[f] == 0 && (f < 39 || cheeks_follow)) frame.mask.reset(f);
  }
  return frame;
}

}  // namespace

void lids_follow_gaze(const Rig& rig, fap::Frame& frame) {
  for (std::size_t side = 0; side < 2 && rig.shapes.empty(); ++side) {
    const int lid = 19 + int(side);
    const std::size_t pitch = 25 + side;
    if (frame.mask[std::size_t(lid)] || !frame.mask[pitch] || frame.value[pitch] == 0) continue;
    frame.set(lid, std::int32_t(std::lround(rig.lid_follow[side] * float(frame.value[pitch]))));
  }
}

bool has_own_visemes(const Rig& rig) {
  std::array<bool, fap::kVisemeCount> has = {true};
  for (const ShapeControl& shape : rig.shapes) {
    if (shape.viseme) has[std::size_t(*shape.viseme)] = true;
  }
  return std::all_of(has.begin(), has.end(), [](bool one) { return one; });
}

namespace {

constexpr std::array kMouthGroups = {1, 5, 7};  // jaw and inner lips, tongue, outer lips

bool moves_mouth(const fap::Frame& frame) {
  for (const int group : kMouthGroups) {
    const auto& [first, size, name] = fap::kGroups[std::size_t(group)];
    for (int f = first; f < first + size; ++f) {
      if (frame.mask[std::size_t(f)]) return true;
    }
  }
  return false;
}

bool moves_brows(const fap::Frame& frame) {
  constexpr int kBrows = 3;
  const auto& [first, size, name] = fap::kGroups[kBrows];
  for (int f = first; f < first + size; ++f) {
    if (frame.mask[std::size_t(f)]) return true;
  }
  return false;
}

// FAP 2 by expressions that the head's maker made; those shown are taken out of the frame. `whole`:
// nothing else moves the mouth.
void show_own_expressions(const Rig& rig, bool whole, fap::Frame& frame, ControlValues& values) {
  constexpr int kMostIntensity = 63;
  if (!frame.mask[2] || moves_brows(frame)) return;
  fap::Expression& coded = frame.expression;
  for (const auto& [select, intensity] :
       {std::pair(coded.select1, &coded.intensity1), std::pair(coded.select2, &coded.intensity2)}) {
    if (select < 1 || *intensity <= 0) continue;
    for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
      const ShapeControl& shape = rig.shapes[i];
      if (shape.expression != select || shape.upper == whole) continue;
      values[kFirstShape + i] +=
          kFullShape * float(std::min(*intensity, kMostIntensity)) / kMostIntensity;
      *intensity = 0;
      break;
    }
  }
}

// Weights of visemes by shapes that are visemes by name, where all that is shown are there.
bool show_visemes(const Rig& rig, fap::VisemeWeights weights, ControlValues& values) {
  weights[0] = 0;  // silence is the face at rest
  std::vector<std::pair<std::size_t, float>> shown;
  for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
    if (!rig.shapes[i].viseme) continue;
    double& weight = weights[std::size_t(*rig.shapes[i].viseme)];
    if (weight > 0) shown.emplace_back(kFirstShape + i, float(weight) * kFullShape);
    weight = 0;
  }
  if (std::any_of(weights.begin(), weights.end(), [](double weight) { return weight > 0; })) {
    return false;
  }
  for (const auto& [control, value] : shown) values[control] = value;
  return true;
}

// Those of FAP 1, which is taken out.
bool show_own_visemes(const Rig& rig, fap::Frame& frame, ControlValues& values) {
  if (!frame.mask[1] || moves_mouth(frame)) return false;
  if (!show_visemes(rig, fap::coded_viseme(frame.viseme), values)) return false;
  frame.mask.reset(1);
  return true;
}

// What corners of the mouth do beyond speech, in which they are between kSpokenDown and kSpokenUp:
// a mood pulls them.
double pulled_corner(double raised) {
  constexpr double kSpokenDown = -145, kSpokenUp = 100, kSteeperUp = 1.5, kSteeperDown = 2.5;
  const double beyond = raised - std::clamp(raised, kSpokenDown, kSpokenUp);
  const double steeper = beyond > 0 ? kSteeperUp : kSteeperDown;
  return std::clamp(steeper * beyond, -std::abs(raised), std::abs(raised));
}

// ARKit's smile and frown beside visemes, as far as a mood pulls the corners.
void pull_corners(const Rig& rig, const fap::Frame& low, double share, ControlValues& values) {
  struct Puller {
    std::optional<int> shape;
    std::size_t fap;
    double side;  // 1: up
  };
  static const std::array<Puller, 4> kPullers = {{{fap::find_arkit("mouthSmileLeft"), 12, 1},
                                                  {fap::find_arkit("mouthSmileRight"), 13, 1},
                                                  {fap::find_arkit("mouthFrownLeft"), 12, -1},
                                                  {fap::find_arkit("mouthFrownRight"), 13, -1}}};
  constexpr double kLeastEffect = 30, kMostWeight = 0.8;
  for (const Puller& puller : kPullers) {
    const double wanted =
        puller.side * pulled_corner(low.mask[puller.fap] ? low.value[puller.fap] : 0);
    if (!(wanted > 0)) continue;
    for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
      const double effect = puller.side * rig.shapes[i].faps.value[puller.fap];
      if (rig.shapes[i].arkit != puller.shape || effect < kLeastEffect) continue;
      values[kFirstShape + i] += float(share * std::min(wanted / effect, kMostWeight)) * kFullShape;
      break;
    }
  }
}

// Those of a script, in place of what the frame says of the mouth: that shows in pauses alone, but
// for a smile and its like.
bool show_script(const Rig& rig, const fap::VisemeWeights& weights, fap::Frame& low,
                 ControlValues& values) {
  if (!has_own_visemes(rig) || !show_visemes(rig, weights, values)) return false;
  const double pause = std::clamp(weights[0], 0.0, 1.0);
  pull_corners(rig, low, 1 - pause, values);
  for (const int group : kMouthGroups) {
    const auto& [first, size, name] = fap::kGroups[std::size_t(group)];
    for (int f = first; f < first + size; ++f) {
      std::int32_t& value = low.value[std::size_t(f)];
      value = std::int32_t(std::lround(pause * value));
    }
  }
  return true;
}

// The tongue of a script, where the frame says nothing of it: speech of models moves jaw and lips.
void move_tongue(const fap::VisemeWeights& weights, fap::Frame& low) {
  constexpr std::array<std::size_t, 5> kTongue = {43, 44, 45, 46, 47};
  const bool given = std::any_of(kTongue.begin(), kTongue.end(),
                                 [&](std::size_t f) { return low.mask[f] && low.value[f] != 0; });
  if (given) return;
  std::array<double, fap::kFapCount + 1> sums{};
  for (std::size_t v = 1; v < weights.size(); ++v) {
    if (weights[v] <= 0) continue;
    const fap::Frame shape = fap::viseme_pose(int(v));
    for (const std::size_t f : kTongue) sums[f] += weights[v] * shape.value[f];
  }
  for (const std::size_t f : kTongue) {
    if (sums[f] != 0) low.set(int(f), std::int32_t(std::lround(sums[f])));
  }
}

}  // namespace

namespace {

// A fitter for the shapes of a rig. Making one takes as long as fitting a frame, and rigs are
// values that may be changed and copied: it is kept for as long as the next rig has the same
// shapes.
class KeptFitter {
 public:
  const std::vector<double>& fit(const Rig& rig, const fap::Frame& frame) {
    if (!fitter_ || !is_of(rig)) {
      shapes_.clear();
      channels_.clear();
      for (const ShapeControl& shape : rig.shapes) {
        shapes_.push_back(shape.faps);
        channels_.push_back(shape.arkit);
      }
      lips_ = rig.lip_measures;
      fitter_.emplace(shapes_, lips_, 0.001, channels_);
    }
    return fitter_->fit(frame);
  }

 private:
  bool is_of(const Rig& rig) const {
    if (rig.shapes.size() != shapes_.size() || rig.lip_measures.at_rest != lips_.at_rest ||
        rig.lip_measures.closing != lips_.closing) {
      return false;
    }
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      const ShapeControl& shape = rig.shapes[i];
      if (shape.arkit != channels_[i] || shape.faps.mask != shapes_[i].mask ||
          shape.faps.value != shapes_[i].value) {
        return false;
      }
    }
    return true;
  }

  std::vector<fap::Frame> shapes_;
  std::vector<std::optional<int>> channels_;
  fap::LipMeasures lips_;
  std::optional<fap::ShapeFitter> fitter_;
};

// A gain opens the jaw further, but where the chin was not measured (FAP 14, 18 and cheeks at 0,
// see wanted_of_shapes()) it says no more than before.
fap::Frame opened_for_shapes(const fap::Frame& low, double gain) {
  fap::Frame wide = fap::open_wider(low, gain);
  for (const std::size_t f : {14, 18, 39, 40, 41, 42}) {
    if (low.value[f] == 0) wide.value[f] = 0;
  }
  return wide;
}

}  // namespace

ControlValues control_values(const Rig& rig, const fap::Frame& frame, const PoseOptions& options) {
  ControlValues values(kFirstShape + rig.shapes.size());
  fap::Frame rest = frame;
  const bool silent = !frame.mask[1] && !moves_mouth(frame) && !options.visemes;
  if (!rig.shapes.empty()) show_own_expressions(rig, silent, rest, values);
  fap::Frame low = low_level(rest);
  if (rig.mouth_gain != 1) {
    low = rig.shapes.empty() ? fap::open_wider(low, rig.mouth_gain)
                             : opened_for_shapes(low, rig.mouth_gain);
  }
  if (options.follow) lids_follow_gaze(rig, low);
  if (options.visemes) move_tongue(*options.visemes, low);
  for (std::size_t f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    values[f] = low.mask[f] ? float(low.value[f]) : 0;
  }
  if (rig.shapes.empty()) return values;
  const bool by_script = options.visemes && show_script(rig, *options.visemes, low, values);
  if (!by_script && show_own_visemes(rig, rest, values)) low = low_level(rest);
  static const std::optional<int> kJaw = fap::find_arkit("jawOpen");
  const bool cheeks_follow =
      std::any_of(rig.shapes.begin(), rig.shapes.end(),
                  [](const ShapeControl& shape) { return shape.arkit == kJaw; });
#ifdef __wasm__  // one thread, and nothing that ends it
  static KeptFitter& fitter = *new KeptFitter;
#else
  thread_local KeptFitter fitter;
#endif
  const std::vector<double>& weights = fitter.fit(rig, wanted_of_shapes(low, cheeks_follow));
  for (std::size_t i = 0; i < weights.size(); ++i) {
    values[kFirstShape + i] =
        std::min(values[kFirstShape + i] + float(weights[i]) * kFullShape, kFullShape);
  }
  return values;
}

namespace {

// All that deforms, before the head turns.
void deform(const Rig& rig, const Values& values, bool contact, Pose& out) {
  for (std::size_t part = 0; part < rig.parts.size(); ++part) {
    if (rig.deforms[part]) out.positions[part] = rig.parts[part].positions;
  }
  std::vector<Vec3>& skin = out.positions[index(Part::skin)];
  apply_targets(rig, values, true, out);
  slide_lids(rig, skin);
  apply_targets(rig, values, false, out);
  keep_off_eyes(rig, values, skin);
  if (!contact) return;
  detail::keep_off_teeth(rig, rig.teeth[0], {}, skin);
  detail::keep_off_teeth(rig, rig.teeth[1],
                         detail::jaw_transform(rig, values[3], values[14], values[15]), skin);
  const float touch = float(fap::internal::kTouch * rig.fapu.mns);
  close_pairs(rig.lips, touch, skin);
  for (const auto& lids : rig.lids) close_pairs(lids, touch, skin);
}

}  // namespace

void pose(const Rig& rig, const fap::Frame& frame, Pose& out, const PoseOptions& options) {
  pose(rig, control_values(rig, frame, options), out, options);
}

void pose(const Rig& rig, const ControlValues& wanted, Pose& out, const PoseOptions& options) {
  Values values;
  std::vector<Vec3>& skin = out.positions[index(Part::skin)];
  const auto show = [&](const Values& shown) {
    values = shown;
    if (options.contact) detail::stop_at_contact(rig, values);
    deform(rig, values, options.contact, out);
  };
  if (options.contact) {
    detail::show_whole(rig, wanted, skin, show);
  } else {
    show(wanted);
  }
  turn_lashes(rig, skin, out.positions[index(Part::lashes)]);
  set_transforms(rig, values, out);
  turn_neck(rig, out.head, skin);
  for (std::size_t part = 0; part < rig.parts.size(); ++part) {
    if (!rig.deforms[part]) continue;
    detail::smooth_normals(out.positions[part], rig.parts[part].triangles, out.normals[part]);
  }
}

Pose pose(const Rig& rig, const fap::Frame& frame, const PoseOptions& options) {
  Pose out;
  pose(rig, frame, out, options);
  return out;
}

}  // namespace animeme::head
