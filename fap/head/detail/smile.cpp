#include "fap/head/detail/smile.h"

#include "fap/head/detail/normals.h"

namespace animeme::head::detail {
namespace {

// Across the fold, in shares of the distance from nose to corner: positive is outwards.
float profile(float across, float along) {
  const auto hill = [](float x, float wide) { return std::exp(-x * x / (wide * wide)); };
  const float crease = smooth_step(-0.15f, 0.25f, along) * smooth_step(1.3f, 0.8f, along);
  const float apple = smooth_step(-0.35f, 0.25f, along) * smooth_step(1.25f, 0.5f, along);
  return apple * hill(across - 0.42f, 0.36f) * smooth_step(-0.06f, 0.3f, across) -
         0.42f * crease * hill(across, 0.09f);
}

// How far each vertex of the skin stands out: 1 on the apple of the cheek, 0 at feature points.
std::vector<float> smile_bulge(const Head& head, const Weights& weights, bool left) {
  const std::string_view wing_id = left ? "9.1" : "9.2", corner_id = left ? "2.4" : "2.5";
  for (const std::string_view id : {wing_id, corner_id, std::string_view(left ? "5.1" : "5.2")}) {
    if (!head.point(id).exists() || head.point(id).part != Part::skin) return {};
  }
  const Vec3 wing = head.at(wing_id);
  const Vec3 way = head.at(corner_id) - wing;
  const float size = std::hypot(way.x, way.y);
  if (!(size > 0)) return {};
  const float side = left ? 1.0f : -1.0f;
  const Vec3 down{way.x / size, way.y / size, 0};
  const Vec3 out{-side * down.y, side * down.x, 0};
  std::vector<float> bulge;
  for (const Vec3& p : head.part(Part::skin).positions) {
    const float along = dot(p - wing, down) / size;
    // The fold leaves the nose and passes the corner at some distance.
    const float across = dot(p - wing, out) / size - 0.06f - 0.22f * along;
    const bool before = p.z > wing.z - 1.2f * size && side * p.x > 0;
    bulge.push_back(before ? profile(across, along) : 0);
  }
  hold_points(head, weights, bulge);
  return bulge;
}

}  // namespace

std::vector<Target> cheek_targets(const Head& head, const Weights& weights) {
  constexpr float kLeast = 0.002f;  // smaller moves are nothing
  // Of each side, and how much of the bulge a FAP brings about, against its own move.
  const struct {
    int left, right;
    float share;
    float most;  // in its units, beyond which the cheek is full
  } causes[] = {{6, 7, 0.10f, 170}, {12, 13, 0.25f, 380}, {41, 42, 0.38f, 170}};
  const Mesh& skin = head.part(Part::skin);
  std::vector<Vec3> normals;
  smooth_normals(skin.positions, skin.triangles, normals);
  std::vector<Target> targets;
  for (const bool left : {true, false}) {
    const std::vector<float> bulge = smile_bulge(head, weights, left);
    for (const auto& cause : causes) {
      Target target{.control = left ? cause.left : cause.right,
                    .part = Part::skin,
                    .vertices = {},
                    .deltas = {},
                    .low = 0,
                    .high = cause.most};
      const float step = cause.share * float(fap::step_size(target.control, head.fapu));
      for (std::size_t v = 0; v < bulge.size(); ++v) {
        if (std::abs(bulge[v]) <= kLeast) continue;
        target.vertices.push_back(std::uint32_t(v));
        target.deltas.push_back(normals[v] * (bulge[v] * step));
      }
      if (!target.vertices.empty()) targets.push_back(std::move(target));
    }
  }
  return targets;
}

}  // namespace animeme::head::detail
