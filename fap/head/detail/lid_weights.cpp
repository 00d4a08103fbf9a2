#include "fap/head/detail/assemble.h"

namespace animeme::head::detail {
namespace {

// The opening over x against that in the middle: all vertices of a rim arrive at the same time.
double share_of_opening(const Shape& shape, double x) {
  const double inner = shape.inner_corner();
  const double outer = shape.outer_corner();
  const double inside = std::clamp(x, inner, outer);
  const double middle = (inner + outer) / 2;
  return std::max(shape.upper_lid(inside) - shape.lower_lid(inside), 0.0) /
         (shape.upper_lid(middle) - shape.lower_lid(middle));
}

// 1 at the rim, 0 where the skin does not follow any more.
double follow(double distance, double width) {
  const double t = std::clamp(1 - distance / width, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

void weigh_lids(const Shape& shape, Skin& skin, std::size_t vertices) {
  const Layout& l = skin.layout;
  for (auto& weights : skin.seams.lid_weights) weights.assign(vertices, 0);
  for (int side : {1, -1}) {
    auto& upper = skin.seams.lid_weights[side > 0 ? 0 : 2];
    auto& lower = skin.seams.lid_weights[side > 0 ? 1 : 3];
    for (int i = l.eye_inner - 4; i <= l.eye_outer + 4; ++i) {
      const double x = skin.places[skin.at(l.upper_lid, i)].x;
      const double share = share_of_opening(shape, x);
      const double width = shape.crease(x) - shape.upper_lid(x) + 0.85;
      // Away from the rim less and less of its corners, where skin goes along that is no lid.
      const double q = (x - shape.eye.x) / (0.62 * shape.p.eye_width);
      const double even = std::max(1 - q * q, 0.0);
      for (int row = l.brow; row <= l.upper_lid; ++row) {
        const std::uint32_t id = skin.at(row, side * i);
        const double above = skin.places[id].y - shape.upper_lid(x);
        const double here = share + (even - share) * smooth_step(0.0, 0.8, above);
        upper[id] = float(here * follow(above, width));
      }
      if (!l.in_eye(i)) continue;
      for (int row = l.lower_lid; row < l.nose_base; ++row) {
        const std::uint32_t id = skin.at(row, side * i);
        lower[id] = float(share * follow(shape.lower_lid(x) - skin.places[id].y, 0.9));
      }
    }
    // The inner edges of the rims, see add_eye_pocket().
    const auto& pairs = skin.seams.lids[side > 0 ? 0 : 1];
    for (std::size_t k = pairs.size() / 2; k < pairs.size(); ++k) {
      const ContactPair& outer = pairs[k - pairs.size() / 2];
      upper[pairs[k].upper] = upper[outer.upper];
      lower[pairs[k].lower] = lower[outer.lower];
    }
  }
}

}  // namespace animeme::head::detail
