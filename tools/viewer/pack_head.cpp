#include <algorithm>
#include <cmath>

#include "fap/head/shapes.h"
#include "fap/head/srgb.h"
#include "fap/tables.h"
#include "tools/json.h"
#include "tools/render/scene.h"
#include "tools/viewer/detail/bytes.h"
#include "tools/viewer/detail/coats.h"
#include "tools/viewer/viewer.h"

namespace animeme::viewer {
namespace {

using detail::Bytes;
using head::Vec3;
using tools::Json;

constexpr const char* kMaterials[] = {"skin", "eye", "teeth", "wet", "hair", "cloth"};

Json json_of(Vec3 v) { return Json::array({v.x, v.y, v.z}); }

float axis(Vec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

std::uint32_t rounded(float value, float top) {
  return std::uint32_t(std::lround(std::clamp(value, 0.0f, top)));
}

// 0..255, as sRGB.
std::uint32_t shown(float light) {
  const double v = std::clamp(double(light), 0.0, 1.0);
  return std::uint32_t(std::lround(255 * head::srgb_of_linear(v)));
}

Json write_places(const std::vector<Vec3>& places, Bytes& out) {
  Vec3 low;
  float size = 0;
  for (int k = 0; k < 3 && !places.empty(); ++k) {
    const auto [least, most] = std::minmax_element(
        places.begin(), places.end(), [k](Vec3 a, Vec3 b) { return axis(a, k) < axis(b, k); });
    (k == 0 ? low.x : k == 1 ? low.y : low.z) = axis(*least, k);
    size = std::max(size, axis(*most, k) - axis(*least, k));
  }
  const float step = std::max(size, 1e-6f) / 65535;
  for (int k = 0; k < 3; ++k) {
    for (const Vec3 p : places) out.u16(rounded((axis(p, k) - axis(low, k)) / step, 65535));
  }
  return Json{{"low", json_of(low)}, {"step", step}};
}

Json write_part(const head::Mesh& mesh, const std::vector<head::Triangle>& triangles,
                std::string_view name, Bytes& out) {
  Json part{{"name", name},
            {"material", kMaterials[std::size_t(mesh.material)]},
            {"vertices", mesh.positions.size()},
            {"triangles", triangles.size()}};
  // Behind the triangles of the mesh: they bear on normals alone.
  if (triangles.size() > mesh.triangles.size()) part["solid"] = mesh.triangles.size();
  part.update(write_places(mesh.positions, out));
  for (int k = 0; k < 3; ++k) {
    for (const Vec3 c : mesh.colours) out.u8(shown(axis(c, k)));
  }
  for (const float sky : mesh.occlusion) out.u8(rounded(sky * 255, 255));
  std::int64_t last = 0;
  for (const head::Triangle& triangle : triangles) {
    for (const std::uint32_t vertex : triangle) {
      out.zigzag(std::int64_t(vertex) - last);
      last = vertex;
    }
  }
  if (Json facets = detail::write_facets(mesh, out); !facets.is_null()) {
    part["facets"] = std::move(facets);
  }
  return part;
}

Json write_target(const head::Target& target, Bytes& out) {
  std::int64_t last = -1;
  for (const std::uint32_t vertex : target.vertices) {
    out.varint(std::uint64_t(vertex - last - 1));
    last = vertex;
  }
  Json steps = Json::array();
  for (int k = 0; k < 3; ++k) {
    float most = 0;
    for (const Vec3 d : target.deltas) most = std::max(most, std::abs(axis(d, k)));
    const float step = most / 32767;
    steps.push_back(step);
    if (step == 0) continue;  // most targets move along one axis
    for (const Vec3 d : target.deltas) {
      out.u16(std::uint32_t(std::lround(axis(d, k) / step)) & 0xFFFF);
    }
  }
  Json info{{"control", target.control},
            {"part", int(target.part)},
            {"count", target.vertices.size()},
            {"steps", steps}};
  if (std::isfinite(target.low)) info["low"] = target.low;
  if (std::isfinite(target.high)) info["high"] = target.high;
  return info;
}

void write_pairs(const std::vector<head::ContactPair>& pairs, Bytes& out) {
  for (const head::ContactPair& pair : pairs) {
    out.varint(pair.upper);
    out.varint(pair.lower);
  }
}

// The jaw as the rig turns it: what it does is asked, not known.
Json jaw_of(const head::Rig& rig) {
  const auto turned = [&](int fap, int value) {
    fap::Frame frame;
    frame.set(fap, value);
    return head::pose(rig, frame, {.contact = false}).jaw;
  };
  return {{"axis", json_of(rig.jaw_axis)},           {"bite", head::kBite},
          {"sine", turned(3, 512).row_z.y / 512},    {"limit", turned(3, 1 << 20).row_z.y},
          {"thrust", turned(14, 512).shift.z / 512}, {"shift", turned(15, 512).shift.x / 512}};
}

Json reach_of(const head::Reach& reach) { return {reach.fap, reach.low, reach.high}; }

Json rooms_of(const head::Rooms& rooms) {
  return {{"brows", rooms.brows},         {"brow_lid", rooms.brow_lid},
          {"upper_lip", rooms.upper_lip}, {"lower_lip", rooms.lower_lip},
          {"nose_lip", rooms.nose_lip},   {"corner", rooms.corner},
          {"lip_chin", rooms.lip_chin},   {"chin", rooms.chin}};
}

Json teeth_of(const head::DentalArch& arch) {
  return {{"middle", json_of(arch.middle)},
          {"half_width", arch.half_width},
          {"depth", arch.depth},
          {"half_height", arch.half_height},
          {"count", arch.vertices.size()}};
}

Json points_of(const head::Head& head) {
  Json points = Json::array();
  for (std::size_t i = 0; i < head.feature_points.size(); ++i) {
    const head::FeaturePoint& point = head.feature_points[i];
    if (!point.exists()) continue;
    const fap::FeaturePointInfo& info = fap::kFeaturePoints[i];
    points.push_back({{"id", info.id},
                      {"name", info.name},
                      {"part", int(point.part)},
                      {"vertex", point.vertex}});
  }
  return points;
}

// [[fap, value], ...] for each shape.
template <class Shape>
Json shapes_of(int count, Shape shape) {
  Json shapes = Json::array();
  for (int i = 0; i < count; ++i) {
    const fap::Frame frame = shape(i);
    Json values = Json::array();
    for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
      if (frame.mask[std::size_t(f)]) values.push_back({f, frame.value[std::size_t(f)]});
    }
    shapes.push_back(values);
  }
  return shapes;
}

Json camera_of(const head::Head& head) {
  const render::Camera camera = render::look_at(head, 0);
  // Nearer pictures look at another place; from 1.8 on it stays.
  return {{"target", json_of(camera.target)},
          {"near", json_of(render::look_at(head, 0, 0, 1.8).target)},
          {"distance", length(camera.eye - camera.target)},
          {"angle", camera.view_angle}};
}

Json eye_of(const head::Eye& eye) {
  return {{"centre", json_of(eye.centre)}, {"radius", eye.radius}};
}

void write_vertices(const std::vector<std::uint32_t>& vertices, Bytes& out) {
  for (const std::uint32_t vertex : vertices) out.varint(vertex);
}

// How many of the flags are set, then how many are not, and so on; returns how many numbers that
// are.
std::size_t write_runs(const std::vector<bool>& flags, Bytes& out) {
  std::size_t runs = 0;
  for (std::size_t at = 0; at < flags.size(); ++runs) {
    const std::size_t begin = at;
    while (at < flags.size() && flags[at] == (runs % 2 == 0)) ++at;
    out.varint(at - begin);
  }
  return runs;
}

// Which triangles of the skin are those of Rig::outside, which has their order.
std::vector<bool> outside_of(const head::Rig& rig) {
  std::vector<bool> outside;
  auto next = rig.outside.begin();
  for (const head::Triangle& triangle : rig.parts[std::size_t(head::Part::skin)].triangles) {
    outside.push_back(next != rig.outside.end() && next->corners == triangle);
    if (outside.back()) ++next;
  }
  return outside;
}

std::vector<bool> rolling_of(const head::Rig& rig) {
  std::vector<bool> rolling;
  for (const head::OuterTriangle& outer : rig.outside) rolling.push_back(outer.rolls);
  return rolling;
}

}  // namespace

std::vector<std::uint8_t> pack_head(const head::Head& head, const head::Rig& rig) {
  Bytes data;
  Json parts = Json::array();
  for (std::size_t i = 0; i < head.parts.size(); ++i) {
    parts.push_back(write_part(head.parts[i], rig.parts[i].triangles, head::kPartNames[i], data));
  }
  Json targets = Json::array();
  for (const head::Target& target : rig.targets) targets.push_back(write_target(target, data));
  write_pairs(rig.lips, data);
  for (const auto& lids : rig.lids) write_pairs(lids, data);
  for (const auto& vertices : rig.lid_vertices) write_vertices(vertices, data);
  for (const auto& vertices : rig.eye_skin) write_vertices(vertices, data);
  for (const head::DentalArch& arch : rig.teeth) write_vertices(arch.vertices, data);
  write_vertices(rig.lash_anchors, data);
  for (const float weight : rig.neck_weights) data.u16(rounded(weight * 65535, 65535));
  const std::size_t outside = write_runs(outside_of(rig), data);
  const std::size_t rolling = write_runs(rolling_of(rig), data);
  Json header{
      {"version", 3},
      {"name", head.name},
      {"parts", parts},
      {"targets", targets},
      {"deforms", rig.deforms},
      {"shapes", rig.shapes.size()},
      {"shown_by_shapes", rig.shown_by_shapes},
      {"lips", rig.lips.size()},
      {"lids", {rig.lids[0].size(), rig.lids[1].size()}},
      {"sliding", {rig.lid_vertices[0].size(), rig.lid_vertices[1].size()}},
      {"before_eyes", {rig.eye_skin[0].size(), rig.eye_skin[1].size()}},
      {"anchors", rig.lash_anchors.size()},
      {"outside", outside},
      {"rolling", rolling},
      {"usual", rig.usual},
      {"fapu", {{"es", rig.fapu.es}, {"mns", rig.fapu.mns}}},
      {"eyes", tools::json_list(rig.eyes, eye_of)},
      {"jaw", jaw_of(rig)},
      {"rooms", rooms_of(rig.rooms)},
      {"reaches", tools::json_list(rig.reaches, reach_of)},
      {"teeth", {teeth_of(rig.teeth[0]), teeth_of(rig.teeth[1])}},
      {"lid_follow", rig.lid_follow},
      {"neck", json_of(rig.neck_pivot)},
      {"points", points_of(head)},
      {"visemes", shapes_of(int(fap::kVisemes.size()), head::viseme_shape)},
      {"expressions", shapes_of(int(fap::kExpressions.size()), head::expression_shape)},
      {"camera", camera_of(head)},
  };
  if (!head.coats.empty()) header.update(detail::write_coats(head.coats, data));
  return detail::with_header(header, data);
}

}  // namespace animeme::viewer
