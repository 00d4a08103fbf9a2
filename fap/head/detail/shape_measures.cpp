#include "fap/head/detail/shape_measures.h"

#include <algorithm>
#include <cmath>

#include "fap/arkit.h"
#include "fap/detail/lips.h"

namespace animeme::head::detail {
namespace {

// How a target at full strength moves a feature point.
Vec3 shift_of(const Target& target, FeaturePoint point) {
  if (target.part != point.part) return {};
  const auto& vertices = target.vertices;
  const auto at = std::lower_bound(vertices.begin(), vertices.end(), point.vertex);
  const bool moves = at != vertices.end() && *at == point.vertex;
  return moves ? target.deltas[std::size_t(at - vertices.begin())] * kFullShape : Vec3{};
}

// Jaw, chin and lips; the tongue is not among them.
bool of_mouth(int fap) {
  const fap::FapInfo& info = fap::info(fap);
  const bool lengths = info.unit != fap::Unit::angle && !info.feature_point.empty();
  return lengths && (info.group == 2 || info.group == 8);
}

bool shows_mouth(const fap::Frame& faps) {
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    if (of_mouth(f) && faps.mask[std::size_t(f)] && faps.value[std::size_t(f)] != 0) return true;
  }
  return false;
}

// Where a shape that opens the jaw leaves the chin (a mouth that opens within the skin), or no chin
// is known, FAP 3 still opens it: as far as its lower lip goes, of what its name means.
void open_without_chin(const fap::Frame& meant, fap::Frame& faps) {
  constexpr std::size_t kJawOpens = 3, kLowerLip = 5;
  constexpr double kLeavesChin = 0.1, kMost = 1.5;
  const double full = meant.value[kJawOpens], lip = -double(meant.value[kLowerLip]);
  if (!meant.mask[kJawOpens] || !(full > 0) || !(lip > 0) || !faps.mask[kLowerLip]) return;
  if (faps.mask[kJawOpens] && faps.value[kJawOpens] >= kLeavesChin * full) return;
  const double share = std::clamp(-double(faps.value[kLowerLip]) / lip, 0.0, kMost);
  if (share > 0) faps.set(int(kJawOpens), std::int32_t(std::lround(share * full)));
}

// How far a shape puts the tongue out, where the head has one as a part of its own: at the vertex
// that is in front. ARKit's table says a mouth's width, and makers mean anything.
void measure_tongue(const Rig& rig, std::size_t index, fap::Frame& faps) {
  constexpr int kTongueOut = 45;
  constexpr double kLeast = 100;  // less is another shape's
  const auto& rest = rig.parts[std::size_t(Part::tongue)].positions;
  const float unit = float(fap::step_size(kTongueOut, rig.fapu));
  if (rest.empty() || !(unit > 0)) return;
  const auto front =
      std::max_element(rest.begin(), rest.end(), [](Vec3 a, Vec3 b) { return a.z < b.z; });
  const FeaturePoint tip{Part::tongue, std::uint32_t(front - rest.begin())};
  double out = 0;
  for (const Target& target : rig.targets) {
    if (target.control == kFirstShape + int(index)) out += double(shift_of(target, tip).z / unit);
  }
  if (out >= kLeast) faps.set(kTongueOut, std::int32_t(std::lround(out)));
}

}  // namespace

fap::LipMeasures lip_measures(const Head& head, const Rig& rig) {
  // Points farther apart at rest, in shares of MNS, are not where the lips meet.
  constexpr float kMostAtRest = 0.15f * 1024;
  fap::LipMeasures measures;
  measures.closing.resize(rig.shapes.size());
  const float unit = float(fap::step_size(4, rig.fapu));
  for (std::size_t k = 0; k < fap::internal::kLipPairs; ++k) {
    const auto& [up, low] = fap::internal::kLips[k];
    const std::string_view upper_id = fap::info(up).feature_point;
    const std::string_view lower_id = fap::info(low).feature_point;
    const FeaturePoint upper = head.point(upper_id), lower = head.point(lower_id);
    if (!upper.exists() || !lower.exists() || !(unit > 0)) {
      for (std::size_t i = 0; i < rig.shapes.size(); ++i) {
        const auto& value = rig.shapes[i].faps.value;
        measures.closing[i][k] = float(value[std::size_t(up)] + value[std::size_t(low)]);
      }
      continue;
    }
    measures.at_rest[k] =
        std::clamp((head.at(upper_id).y - head.at(lower_id).y) / unit, 0.0f, kMostAtRest);
    for (const Target& target : rig.targets) {
      if (target.control < kFirstShape) continue;
      measures.closing[std::size_t(target.control - kFirstShape)][k] +=
          (shift_of(target, lower).y - shift_of(target, upper).y) / unit;
    }
  }
  return measures;
}

// A shape that is named after a FAP does what its maker made: as far as it moves the point, or
// where that is not known any vertex, along the axis.
void measure_single(const Head& head, const Rig& rig, std::size_t index, ShapeControl& shape) {
  constexpr double kLeast = 30;  // units: less is hardly that FAP
  if (shape.arkit || shape.viseme || shape.faps.mask.count() != 1) return;
  int fap = fap::kFirstLowLevel;
  while (fap < fap::kFapCount && !shape.faps.mask[std::size_t(fap)]) ++fap;
  const fap::FapInfo& info = fap::info(fap);
  const float unit = float(fap::step_size(fap, rig.fapu));
  if (info.unit == fap::Unit::angle || info.feature_point.empty() || !(unit > 0)) return;
  const fap::Point move = fap::move_of(fap).axis;
  const Vec3 axis = {float(move[0]), float(move[1]), float(move[2])};
  const FeaturePoint point = head.point(info.feature_point);
  double units = 0;
  for (const Target& target : rig.targets) {
    if (target.control != kFirstShape + int(index)) continue;
    if (point.exists()) {
      units += double(dot(shift_of(target, point), axis) / unit);
      continue;
    }
    for (const Vec3& delta : target.deltas) {
      units = std::max(units, double(dot(delta, axis) * kFullShape / unit));
    }
  }
  if (std::abs(units) >= kLeast) shape.faps.set(fap, std::int32_t(std::lround(units)));
}

std::vector<ShapeControl> measured_shapes(const Head& head, const Rig& rig) {
  static const std::optional<int> kJaw = fap::find_arkit("jawOpen");
  static const std::optional<int> kTongue = fap::find_arkit("tongueOut");
  std::vector<ShapeControl> shapes = head.shapes;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].arkit == kTongue) measure_tongue(rig, i, shapes[i].faps);
    measure_single(head, rig, i, shapes[i]);
  }
  // Not by std::ranges, which Emscripten's library does not have.
  const bool arkit = std::any_of(shapes.begin(), shapes.end(),
                                 [](const ShapeControl& shape) { return shape.arkit == kJaw; });
  constexpr std::array kLips = {"2.2", "2.3", "2.4", "2.5"};
  const bool lips = std::all_of(kLips.begin(), kLips.end(),
                                [&](const char* id) { return head.point(id).exists(); });
  if (arkit || !lips) return shapes;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    ShapeControl& shape = shapes[i];
    if (shape.arkit == fap::kWholeFace || !shows_mouth(shape.faps)) continue;
    const fap::Frame meant = shape.faps;
    for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
      if (!of_mouth(f)) continue;
      const FeaturePoint point = head.point(fap::info(f).feature_point);
      const float unit = float(fap::step_size(f, rig.fapu));
      shape.faps.mask.reset(std::size_t(f));
      if (!point.exists() || !(unit > 0)) continue;
      const fap::Point move = fap::move_of(f).axis;
      const Vec3 axis = {float(move[0]), float(move[1]), float(move[2])};
      Vec3 shift;
      for (const Target& target : rig.targets) {
        if (target.control == kFirstShape + int(i)) shift += shift_of(target, point);
      }
      shape.faps.set(f, std::int32_t(std::lround(dot(shift, axis) / unit)));
    }
    open_without_chin(meant, shape.faps);
  }
  return shapes;
}

}  // namespace animeme::head::detail
