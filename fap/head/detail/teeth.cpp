#include "fap/head/detail/targets.h"

namespace animeme::head::detail {
namespace {

constexpr float kClear = 1.07f;  // skin comes no nearer to the middle of the arch, its edge is 1
constexpr float kSoft = 0.05f;   // the push begins gently, over this
constexpr float kReach = 1.9f;   // skin further out is never near
constexpr float kTight = 0.96f;  // some lips lie on the gums: nearer skin is the bag of the mouth

// Where a place is in the arch seen from above: 1 on its outer edge. Incisors stand nearly side by
// side: an ellipse around the whole row would reach through the lips before them.
float ratio(const DentalArch& arch, Vec3 p) {
  const float x = std::abs(p.x - arch.middle.x) / arch.half_width;
  const float z = std::abs(p.z - arch.middle.z) / arch.depth;
  return std::pow(x * x * std::sqrt(x) + z * z * std::sqrt(z), 0.4f);
}

}  // namespace

DentalArch dental_arch(const Rig& rig, Part teeth) {
  DentalArch arch;
  const auto& places = rig.parts[std::size_t(teeth)].positions;
  if (places.empty()) return arch;
  Vec3 low = places[0];
  Vec3 high = places[0];
  for (const Vec3& p : places) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  arch.half_width = 0.5f * (high.x - low.x);
  arch.depth = high.z - low.z;
  arch.middle = {0.5f * (low.x + high.x), 0.5f * (low.y + high.y), low.z};
  arch.half_height = 0.5f * (high.y - low.y);
  if (arch.half_width <= 0 || arch.depth <= 0) return arch;
  float most = 1;
  for (const Vec3& p : places) most = std::max(most, ratio(arch, p));
  arch.half_width *= most;
  arch.depth *= most;
  const auto& skin = rig.parts[std::size_t(Part::skin)].positions;
  for (std::uint32_t v = 0; v < skin.size(); ++v) {
    const float r = ratio(arch, skin[v]);
    const float above = std::abs(skin[v].y - arch.middle.y);
    if (skin[v].z < arch.middle.z || r <= kTight || r > kReach || above > 6 * arch.half_height)
      continue;
    arch.vertices.push_back(v);
  }
  return arch;
}

void keep_off_teeth(const Rig& rig, const DentalArch& arch, const Transform& place,
                    std::vector<Vec3>& skin) {
  const auto& neutral = rig.parts[std::size_t(Part::skin)].positions;
  const bool fixed = place == Transform{};
  const Transform back = inverse(place);
  for (const std::uint32_t v : arch.vertices) {
    const Vec3 p = fixed ? skin[v] : back(skin[v]);
    const float r = ratio(arch, p);
    const float least = std::min(kClear, ratio(arch, neutral[v]));
    if (r >= least || r < 0.5f || p.z < arch.middle.z) continue;
    // Nothing above and below the row.
    const float here = smooth_step(2.4f, 0.8f, std::abs(p.y - arch.middle.y) / arch.half_height);
    const float inside = least - r;
    const float push = inside * inside / (inside + kSoft) / r * here;
    const Vec3 out{(p.x - arch.middle.x) * push, 0, (p.z - arch.middle.z) * push};
    skin[v] += place.turn(out);
  }
}

}  // namespace animeme::head::detail
