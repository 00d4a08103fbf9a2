#include "fap/head/detail/upper_face.h"

#include <utility>
#include <vector>

namespace animeme::head::detail {
namespace {

// 0 at the mouth, 1 above the nose; between them in the cheeks.
float share_above_mouth(const Rig& rig, Part part, const Vec3& place) {
  switch (part) {
    case Part::upper_teeth:
    case Part::lower_teeth:
    case Part::tongue:
      return 0;
    case Part::skin:
    case Part::body:
    case Part::hair:
      break;
    default:
      return 1;
  }
  const float eyes = 0.5f * (rig.eyes[0].centre.y + rig.eyes[1].centre.y);
  const float nose = eyes - float(rig.fapu.ens);
  return smooth_step(nose - 0.35f * float(rig.fapu.mns), nose + 0.3f * float(rig.fapu.ens),
                     place.y);
}

Target upper_part(const Rig& rig, const Target& whole, int control) {
  Target upper;
  upper.control = control;
  upper.part = whole.part;
  upper.low = whole.low;
  upper.high = whole.high;
  const std::vector<Vec3>& places = rig.parts[std::size_t(whole.part)].positions;
  for (std::size_t k = 0; k < whole.vertices.size(); ++k) {
    const float share = share_above_mouth(rig, whole.part, places[whole.vertices[k]]);
    if (share <= 0) continue;
    upper.vertices.push_back(whole.vertices[k]);
    upper.deltas.push_back(whole.deltas[k] * share);
  }
  return upper;
}

}  // namespace

void add_upper_faces(Rig& rig) {
  if (!(rig.eyes[0].radius > 0) || !(rig.eyes[1].radius > 0) || !(rig.fapu.ens > 0)) return;
  const std::size_t shapes = rig.shapes.size(), targets = rig.targets.size();
  for (std::size_t i = 0; i < shapes; ++i) {
    if (!rig.shapes[i].expression) continue;
    const int control = kFirstShape + int(rig.shapes.size());
    bool moves = false;
    for (std::size_t t = 0; t < targets; ++t) {
      if (rig.targets[t].control != kFirstShape + int(i)) continue;
      Target upper = upper_part(rig, rig.targets[t], control);
      if (upper.vertices.empty()) continue;
      rig.targets.push_back(std::move(upper));
      moves = true;
    }
    if (!moves) continue;
    ShapeControl shape;
    shape.name = rig.shapes[i].name + ".upper";
    shape.expression = rig.shapes[i].expression;
    shape.upper = true;
    rig.shapes.push_back(std::move(shape));
  }
  if (!rig.lip_measures.closing.empty()) rig.lip_measures.closing.resize(rig.shapes.size());
}

}  // namespace animeme::head::detail
