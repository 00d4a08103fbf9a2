#include <algorithm>
#include <cmath>

#include "fap/tables.h"
#include "fap/wider.h"
#include "tools/view/studio/head_sound_internal.h"

namespace animeme::studio {
namespace {

using head::Head;
using head::Part;

constexpr float kFar = 1e4f;  // cm; a head is some 30

bool near(float value) { return std::abs(value) <= kFar; }  // false for what is no number

bool near(head::Vec3 v) { return near(v.x) && near(v.y) && near(v.z); }

template <class T>
bool all_near(const std::vector<T>& values) {
  return std::all_of(values.begin(), values.end(), [](const T& value) { return near(value); });
}

bool are_below(const std::vector<std::uint32_t>& indices, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(), [=](std::uint32_t i) { return i < count; });
}

bool is_sound(const head::Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  if (mesh.colours.size() != count || mesh.occlusion.size() != count) return false;
  if (!all_near(mesh.positions) || !all_near(mesh.colours) || !all_near(mesh.occlusion)) {
    return false;
  }
  for (const head::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= count) return false;
    }
  }
  return mesh.surface <= head::SurfaceKind::cloth;
}

bool is_sound(const head::Eye& eye) {
  if (!near(eye.centre)) return false;
  for (const float size : {eye.radius, eye.iris_radius, eye.pupil_radius}) {
    if (!near(size) || size < 0) return false;
  }
  return true;
}

bool is_sound(const fap::Fapu& fapu) {
  for (const double unit : {fapu.irisd, fapu.es, fapu.ens, fapu.mns, fapu.mw}) {
    if (!(unit > 0 && unit <= double(kFar))) return false;
  }
  return true;
}

bool is_sound(const head::Seams& seams, std::size_t skin) {
  const auto are_pairs = [=](const std::vector<head::ContactPair>& pairs) {
    return std::all_of(pairs.begin(), pairs.end(), [=](const head::ContactPair& pair) {
      return pair.upper < skin && pair.lower < skin;
    });
  };
  const auto are_weights = [=](const std::vector<float>& weights) {
    if (!weights.empty() && weights.size() != skin) return false;
    return std::all_of(weights.begin(), weights.end(),
                       [](float weight) { return weight >= 0 && weight <= 1; });
  };
  return are_pairs(seams.lips) && std::all_of(seams.lids.begin(), seams.lids.end(), are_pairs) &&
         std::all_of(seams.lid_weights.begin(), seams.lid_weights.end(), are_weights) &&
         are_weights(seams.jaw_weights) && are_weights(seams.freedom) &&
         are_weights(seams.neck_weights);
}

bool is_sound(const head::Target& target, const Head& head) {
  if (target.control < fap::kFirstLowLevel || target.control > fap::kFapCount) return false;
  if (std::size_t(target.part) >= head.parts.size()) return false;
  const auto& vertices = target.vertices;
  const bool ascend = std::adjacent_find(vertices.begin(), vertices.end(),
                                         std::greater_equal<>()) == vertices.end();
  // The range may be infinite, but has to be one.
  return ascend && are_below(vertices, head.part(target.part).positions.size()) &&
         target.deltas.size() == vertices.size() && all_near(target.deltas) &&
         target.low <= target.high;
}

}  // namespace

bool is_sound(const Head& head) {
  const auto mesh_is_sound = [](const head::Mesh& mesh) { return is_sound(mesh); };
  if (!std::all_of(head.parts.begin(), head.parts.end(), mesh_is_sound)) return false;
  for (const head::Eye& eye : head.eyes) {
    if (!is_sound(eye)) return false;
  }
  for (const head::FeaturePoint& point : head.feature_points) {
    if (std::size_t(point.part) >= head.parts.size()) return false;
    if (point.exists() && point.vertex >= head.part(point.part).positions.size()) return false;
  }
  const std::size_t skin = head.part(Part::skin).positions.size();
  if (skin == 0 || !is_sound(head.fapu) || !is_sound(head.seams, skin)) return false;
  if (!near(head.jaw_axis) || !near(head.neck_pivot)) return false;
  if (head.lash_anchors.size() != head.part(Part::lashes).positions.size() ||
      !are_below(head.lash_anchors, skin)) {
    return false;
  }
  const auto target_is_sound = [&](const head::Target& target) { return is_sound(target, head); };
  return head.centimetres > 0 && head.centimetres <= double(kFar) &&
         head.mouth_gain >= fap::kLeastMouthGain && head.mouth_gain <= fap::kMostMouthGain &&
         std::all_of(head.targets.begin(), head.targets.end(), target_is_sound);
}

}  // namespace animeme::studio
