#include "fap/head/rig.h"

#include <limits>

#include "fap/head/detail/normals.h"
#include "fap/head/detail/shape_measures.h"
#include "fap/head/detail/stops.h"
#include "fap/head/detail/targets.h"
#include "fap/head/detail/upper_face.h"
#include "fap/head/detail/whole.h"

namespace animeme::head {
namespace {

// The skin near the eyes keeps its distance from the eyeball when lids move.
std::array<std::vector<std::uint32_t>, 2> sliding_vertices(const Rig& rig) {
  std::array<std::vector<std::uint32_t>, 2> sliding;
  const auto& places = rig.parts[std::size_t(Part::skin)].positions;
  for (const Target& target : rig.targets) {
    if (target.control < 19 || target.control > 22 || target.part != Part::skin) continue;
    const std::size_t side = target.control % 2 == 1 ? 0 : 1;
    const Eye& eye = rig.eyes[side];
    for (const std::uint32_t v : target.vertices) {
      const Vec3 d = places[v] - eye.centre;
      if (eye.radius > 0 && length(d) > eye.radius * 0.95f && d.z > 0) sliding[side].push_back(v);
    }
  }
  for (auto& list : sliding) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return sliding;
}

// Skin before an eyeball, which must not get into it.
std::vector<std::uint32_t> skin_before(const Rig& rig, const Eye& eye) {
  std::vector<std::uint32_t> found;
  const auto& places = rig.parts[std::size_t(Part::skin)].positions;
  for (std::uint32_t v = 0; v < places.size() && eye.radius > 0; ++v) {
    const Vec3 d = places[v] - eye.centre;
    const float distance = length(d);
    if (distance > eye.radius && distance < 2 * eye.radius && d.z > 0) found.push_back(v);
  }
  return found;
}

std::array<bool, kPartCount> deforming(const Rig& rig) {
  std::array<bool, kPartCount> deforms{};
  deforms[std::size_t(Part::skin)] = true;  // turns with the neck
  deforms[std::size_t(Part::lashes)] = !rig.lash_anchors.empty();
  for (const Target& target : rig.targets) deforms[std::size_t(target.part)] = true;
  return deforms;
}

bool any_of(const fap::Frame& frame, int first, int last) {
  for (int f = first; f <= last; ++f) {
    if (frame.value[std::size_t(f)] != 0) return true;
  }
  return false;
}

// By what the shapes are called: a chin that should move and does not is one that it shows, too.
std::array<bool, kPartCount> shown_by_shapes(const Head& head, const Rig& rig) {
  std::array<bool, kPartCount> shown{};
  for (const Target& target : rig.targets) {
    if (target.control < kFirstShape) continue;
    const fap::Frame& faps = head.shapes[std::size_t(target.control - kFirstShape)].faps;
    const bool eye = target.part == Part::left_eye || target.part == Part::right_eye;
    const bool jaw = target.part == Part::lower_teeth || target.part == Part::tongue;
    const bool shows = eye ? any_of(faps, 23, 26) : !jaw || any_of(faps, 3, 3);
    shown[std::size_t(target.part)] = shown[std::size_t(target.part)] || shows;
  }
  return shown;
}

// 1 for the head, 0 at the end of the neck.
std::vector<float> neck_weights(const Rig& rig) {
  std::vector<float> weights;
  const float size = length(rig.chin - rig.neck_pivot);
  const float high = rig.chin.y + 0.03f * size;
  const float low = high - 0.52f * size;
  for (const Vec3& p : rig.parts[std::size_t(Part::skin)].positions) {
    const float before = std::max(p.z - rig.neck_pivot.z, 0.0f);
    weights.push_back(smooth_step(low, high, p.y + 0.25f * before));
  }
  return weights;
}

// A share of the distance of two points, in units of a FAP.
float room(const Head& head, std::string_view a, std::string_view b, int fap, float share = 0.5f) {
  const float unit = float(fap::step_size(fap, head.fapu));
  const bool known = head.point(a).exists() && head.point(b).exists() && unit > 0;
  return known ? share * length(head.at(a) - head.at(b)) / unit : std::numeric_limits<float>::max();
}

// The rim of an upper lid moves over its eyeball by this share of the pitch.
float lid_follow(const Rig& rig, std::size_t side) {
  constexpr float kShare = 0.65f;
  const float unit = float(fap::step_size(19 + int(side), rig.fapu));
  return unit > 0 ? kShare * 1e-5f * rig.eyes[side].radius / unit : 0;
}

Rooms rooms_of(const Head& head) {
  return {.brows = room(head, "4.1", "4.2", 37),
          .brow_lid = room(head, "4.3", "3.13", 33, 0.33f),
          .upper_lip = room(head, "8.1", "2.2", 51),
          .lower_lip = room(head, "8.2", "2.3", 52),
          .nose_lip = room(head, "8.1", "9.15", 51),
          .corner = room(head, "2.4", "8.3", 6),
          .lip_chin = room(head, "8.2", "2.10", 5),
          .chin = room(head, "2.10", "2.1", 18, 0.33f)};
}

}  // namespace

Rig make_rig(const Head& head) {
  Rig rig;
  for (std::size_t i = 0; i < head.parts.size(); ++i) {
    const Mesh& mesh = head.parts[i];
    rig.parts[i].positions = mesh.positions;
    rig.parts[i].triangles = mesh.triangles;
    for (std::size_t f = mesh.triangles.size(); f < mesh.facets.size(); ++f) {
      const auto vertex = [&](std::size_t k) { return mesh.corners[mesh.facets[f][k]].vertex; };
      rig.parts[i].triangles.push_back({vertex(0), vertex(1), vertex(2)});
    }
    detail::smooth_normals(mesh.positions, rig.parts[i].triangles, rig.parts[i].normals);
  }
  rig.fapu = head.fapu;
  rig.eyes = head.eyes;
  rig.jaw_axis = head.jaw_axis;
  rig.neck_pivot = head.neck_pivot;
  rig.chin = chin_of(head);
  rig.lips = head.seams.lips;
  rig.lids = head.seams.lids;
  if (head.lash_anchors.size() == head.part(Part::lashes).positions.size()) {
    rig.lash_anchors = head.lash_anchors;
  }
  rig.mouth_gain = head.mouth_gain;
  rig.targets = head.targets.empty() ? detail::make_targets(head) : head.targets;
  rig.shapes = detail::measured_shapes(head, rig);
  rig.lip_measures = detail::lip_measures(head, rig);
  rig.deforms = deforming(rig);
  rig.shown_by_shapes = shown_by_shapes(head, rig);
  rig.lid_vertices = sliding_vertices(rig);
  // What an artist has modelled is not put right.
  for (std::size_t i = 0; i < 2 && rig.shapes.empty(); ++i) {
    rig.eye_skin[i] = skin_before(rig, rig.eyes[i]);
    rig.teeth[i] = detail::dental_arch(rig, i == 0 ? Part::upper_teeth : Part::lower_teeth);
  }
  rig.rooms = rooms_of(head);
  if ((head.targets.empty() && head.shapes.empty()) || head.eased)
    rig.reaches = detail::usual_reaches();
  for (std::size_t i = 0; i < 2; ++i) rig.lid_follow[i] = lid_follow(rig, i);
  const bool given = head.seams.neck_weights.size() == head.part(Part::skin).positions.size();
  rig.neck_weights = given ? head.seams.neck_weights : neck_weights(rig);
  if (!rig.reaches.empty()) detail::watch_outside(head, rig);
  detail::add_upper_faces(rig);
  return rig;
}

}  // namespace animeme::head
