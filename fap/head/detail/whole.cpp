#include "fap/head/detail/whole.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "fap/arkit.h"
#include "fap/tables.h"

namespace animeme::head::detail {
namespace {

// From rest on until the first triangle turns over, which is then found to 1/512. Not from the
// other end: faces may be whole again beyond their first fold, but would jump to there.
constexpr int kSteps = 16;
constexpr int kHalvings = 5;

Vec3 normal_of(const std::vector<Vec3>& places, const Triangle& t) {
  return cross(places[t[1]] - places[t[0]], places[t[2]] - places[t[0]]);
}

// Where the outside ends.
std::vector<bool> seam_of(const Head& head) {
  std::vector<bool> seam(head.part(Part::skin).positions.size());
  const auto add = [&seam](const std::vector<ContactPair>& pairs) {
    for (const ContactPair& pair : pairs) seam[pair.upper] = seam[pair.lower] = true;
  };
  add(head.seams.lips);
  for (const auto& lids : head.seams.lids) add(lids);
  for (const char* corner : {"2.4", "2.5", "3.7", "3.8", "3.11", "3.12"}) {
    if (const FeaturePoint point = head.point(corner); point.exists()) seam[point.vertex] = true;
  }
  return seam;
}

// Triangles by vertex: those of v are in `triangles` from `first[v]` to `first[v + 1]`.
struct Fans {
  std::vector<std::uint32_t> first, triangles;

  Fans(const std::vector<Triangle>& all, std::size_t vertices)
      : first(vertices + 1), triangles(3 * all.size()) {
    for (const Triangle& t : all) {
      for (const std::uint32_t v : t) ++first[v];
    }
    for (std::size_t v = 0, end = 0; v < first.size(); ++v)
      first[v] = std::uint32_t(end += first[v]);
    for (std::uint32_t t = 0; t < all.size(); ++t) {
      for (const std::uint32_t v : all[t]) triangles[--first[v]] = t;
    }
  }
};

// Eyeballs and the head turn as they are.
bool bends_skin(std::size_t control) {
  return !(control >= 23 && control <= 26) && !(control >= 48 && control <= 50);
}

// The share of all at which every FAP is within what is usual.
float usual_share(const Rig& rig, const ControlValues& wanted) {
  float share = 1;
  for (std::size_t f = fap::kFirstLowLevel; f < rig.usual.size(); ++f) {
    if (bends_skin(f) && std::abs(wanted[f]) > rig.usual[f]) {
      share = std::min(share, rig.usual[f] / std::abs(wanted[f]));
    }
  }
  return share;
}

// `all`: or those alone that never roll.
bool any_turned(const Rig& rig, const std::vector<Vec3>& skin, bool all) {
  return std::any_of(rig.outside.begin(), rig.outside.end(), [&](const OuterTriangle& outer) {
    return (all || !outer.rolls) && dot(outer.normal, normal_of(skin, outer.corners)) < 0;
  });
}

}  // namespace

std::vector<OuterTriangle> outside_of(const Head& head) {
  const Mesh& skin = head.part(Part::skin);
  if (head.seams.lips.empty() || !head.point("2.1").exists()) return {};
  const std::vector<bool> seam = seam_of(head);
  const Fans fans(skin.triangles, skin.positions.size());
  std::vector<bool> reached(skin.positions.size());
  std::vector<std::uint32_t> open{head.point("2.1").vertex};
  reached[open[0]] = true;
  while (!open.empty()) {
    const std::uint32_t v = open.back();
    open.pop_back();
    for (std::uint32_t i = fans.first[v]; i < fans.first[v + 1]; ++i) {
      for (const std::uint32_t next : skin.triangles[fans.triangles[i]]) {
        if (reached[next] || seam[next]) continue;
        reached[next] = true;
        open.push_back(next);
      }
    }
  }
  std::vector<OuterTriangle> outside;
  for (const Triangle& t : skin.triangles) {
    if (!reached[t[0]] || !reached[t[1]] || !reached[t[2]]) continue;
    outside.push_back({t, normal_of(skin.positions, t)});
  }
  return outside;
}

std::array<float, fap::kFapCount + 1> usual_values() {
  std::array<float, fap::kFapCount + 1> usual{};
  for (const fap::FapInfo& info : fap::kFaps) {
    usual[std::size_t(info.number)] = 0.1f * float(info.quant_step * info.default_i_range);
  }
  for (std::size_t shape = 0; shape < fap::kArkitChannelCount; ++shape) {
    fap::ArkitFrame weights{};
    weights[shape] = 1;
    const fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
    for (std::size_t f = fap::kFirstLowLevel; f < usual.size(); ++f) {
      if (frame.mask[f]) usual[f] = std::max(usual[f], float(std::abs(frame.value[f])));
    }
  }
  return usual;
}

void mark_rolling(Rig& rig) {
  const std::optional<int> jaw = fap::find_arkit("jawOpen");
  if (!jaw || rig.outside.empty()) return;
  Rig unwatched = rig;
  unwatched.outside.clear();
  fap::ArkitFrame weights{};
  weights[std::size_t(*jaw)] = 1;
  const Pose open = pose(unwatched, fap::arkit_to_fap(weights, fap::kAllArkit));
  const std::vector<Vec3>& skin = open.positions[std::size_t(Part::skin)];
  for (OuterTriangle& outer : rig.outside) {
    outer.rolls = dot(outer.normal, normal_of(skin, outer.corners)) < 0;
  }
}

void show_whole(const Rig& rig, const ControlValues& wanted, const std::vector<Vec3>& skin,
                const std::function<void(const ControlValues&)>& show) {
  const float usual = usual_share(rig, wanted);
  ControlValues values = wanted;
  const auto turned_at = [&](float share) {
    for (std::size_t c = 0; c < values.size(); ++c) {
      if (bends_skin(c)) values[c] = wanted[c] * share;
    }
    show(values);
    return any_turned(rig, skin, share > usual);
  };
  if (!turned_at(1)) return;
  float step = 1.0f / kSteps;
  float whole = 0;
  for (int i = 1; i < kSteps && !turned_at(whole + step); ++i) whole += step;
  for (int i = 0; i < kHalvings; ++i) {
    step /= 2;
    if (!turned_at(whole + step)) whole += step;
  }
  turned_at(whole);
}

}  // namespace animeme::head::detail
