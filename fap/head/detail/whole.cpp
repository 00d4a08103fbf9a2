#include "fap/head/detail/whole.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "fap/arkit.h"
#include "fap/head/detail/geodesic.h"
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

std::vector<OuterTriangle> outside_of(const Head& head) {
  const Mesh& skin = head.part(Part::skin);
  if (head.seams.lips.empty() || !head.point("2.1").exists()) return {};
  const std::vector<bool> seam = seam_of(head);
  const Neighbours neighbours = neighbours_of(skin.positions.size(), skin.triangles);
  std::vector<bool> reached(skin.positions.size());
  std::vector<std::uint32_t> open{head.point("2.1").vertex};
  reached[open[0]] = true;
  while (!open.empty()) {
    const std::uint32_t v = open.back();
    open.pop_back();
    for (const std::uint32_t next : neighbours.of(v)) {
      if (reached[next] || seam[next]) continue;
      reached[next] = true;
      open.push_back(next);
    }
  }
  std::vector<OuterTriangle> outside;
  for (const Triangle& t : skin.triangles) {
    if (!reached[t[0]] || !reached[t[1]] || !reached[t[2]]) continue;
    outside.push_back({t, normal_of(skin.positions, t)});
  }
  return outside;
}

fap::Frame shape_frame(std::size_t shape) {
  fap::ArkitFrame weights{};
  weights[shape] = 1;
  return fap::arkit_to_fap(weights, fap::kAllArkit);
}

}  // namespace

void watch_outside(const Head& head, Rig& rig) {
  for (const fap::FapInfo& info : fap::kFaps) {
    rig.usual[std::size_t(info.number)] = 0.1f * float(info.quant_step * info.default_i_range);
  }
  for (std::size_t shape = 0; shape < fap::kArkitChannelCount; ++shape) {
    const fap::Frame frame = shape_frame(shape);
    for (std::size_t f = fap::kFirstLowLevel; f < rig.usual.size(); ++f) {
      if (frame.mask[f]) rig.usual[f] = std::max(rig.usual[f], float(std::abs(frame.value[f])));
    }
  }
  std::vector<OuterTriangle> outside = outside_of(head);
  static const std::optional<int> kJaw = fap::find_arkit("jawOpen");
  if (!kJaw || outside.empty()) return;
  // Nothing is watched yet.
  const Pose open = pose(rig, shape_frame(std::size_t(*kJaw)));
  const std::vector<Vec3>& skin = open.positions[std::size_t(Part::skin)];
  for (OuterTriangle& outer : outside) {
    outer.rolls = dot(outer.normal, normal_of(skin, outer.corners)) < 0;
  }
  rig.outside = std::move(outside);
}

void show_whole(const Rig& rig, const ControlValues& wanted, const std::vector<Vec3>& skin,
                const std::function<void(const ControlValues&)>& show) {
  const float usual = usual_share(rig, wanted);
  ControlValues values = wanted;
  const auto show_share = [&](float share) {
    for (std::size_t c = 0; c < values.size(); ++c) {
      if (bends_skin(c)) values[c] = wanted[c] * share;
    }
    show(values);
  };
  const auto turned_at = [&](float share) {
    show_share(share);
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
  show_share(whole);
}

}  // namespace animeme::head::detail
