#include "tools/view/gltf/detail/file_actor.h"

#include <algorithm>
#include <set>

#include "fap/head/own_head.h"
#include "tools/view/gltf/detail/head_reader.h"
#include "tools/view/gltf/detail/target_names.h"
#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace {

// More than any mesh has; what claims more is not looked at.
constexpr std::size_t kMostTargets = 4096;

const Json& first_primitive(const File& file, std::size_t mesh) {
  const std::span<const Json> primitives = list(file.entry("meshes", mesh), "primitives");
  static const Json none;
  return primitives.empty() ? none : primitives.front();
}

std::size_t target_count(const Json& primitive) {
  return std::min(list(primitive, "targets").size(), kMostTargets);
}

// The rest of a rig is for vertices.
head::Rig without_meshes(head::Rig rig) {
  head::Rig bare;
  bare.shapes = std::move(rig.shapes);
  // The file has no such shapes.
  std::erase_if(bare.shapes, [](const head::ShapeControl& shape) { return shape.upper; });
  bare.lip_measures = std::move(rig.lip_measures);
  bare.shown_by_shapes = rig.shown_by_shapes;
  bare.fapu = rig.fapu;
  bare.eyes = rig.eyes;
  bare.jaw_axis = rig.jaw_axis;
  bare.neck_pivot = rig.neck_pivot;
  bare.chin = rig.chin;
  return bare;
}

Result<FileActor> actor_by_names(const File& file, const std::vector<Node>& nodes,
                                 const ReadOptions& options) {
  FileActor actor;
  std::vector<std::string> names;
  std::set<std::string> seen;
  std::set<std::size_t> meshes;
  actor.expressions = vrm_expressions(file, nodes, options.rules);
  for (const Node& node : nodes) {
    if (!node.mesh || !meshes.insert(*node.mesh).second) continue;
    const Json& primitive = first_primitive(file, *node.mesh);
    for (std::size_t t = 0; t < target_count(primitive); ++t) {
      std::string name = target_name(file, actor.expressions, *node.mesh, primitive, t);
      if (seen.insert(name).second) names.push_back(std::move(name));
    }
  }
  if (auto known = check_rules(options.rules, names); !known) return known.error();
  for (const ChosenShape& shape : choose_shapes(names, options.mouth, actor.notes, options.rules)) {
    actor.rig.shapes.push_back(control_of(shape));
    actor.shape_names.emplace_back();
    for (const std::size_t name : shape.names) actor.shape_names.back().push_back(names[name]);
  }
  actor.unknown = unknown_names(names, options.rules);
  actor.joints = find_joints(file, nodes);
  // Whether skin hangs on it is not known.
  actor.joints.jaw = kNoNode;
  return actor;
}

}  // namespace

Result<FileActor> file_actor(std::span<const std::uint8_t> bytes, const File& file,
                             const std::vector<Node>& nodes, const ReadOptions& options) {
  ReadOptions reading = options;
  reading.vertices = 0;  // its colours are not used
  Result<MovedHead> moved = read_moved_head(bytes, reading);
  std::string reason;
  FileActor actor;
  if (moved) {
    const bool any = !moved->file.source.shapes.empty();
    actor.unknown = moved->file.unknown;
    // Shadows, which would be looked for, show no motion.
    for (head::Piece& piece : moved->file.source.pieces) {
      piece.mesh.occlusion.assign(piece.mesh.positions.size(), 1);
    }
    auto head = head::assemble(std::move(moved->file.source), &actor.notes);
    if (head) {
      actor.rig = without_meshes(head::make_rig(*head));
      actor.shape_names = std::move(moved->shape_names);
      actor.expressions = vrm_expressions(file, nodes, options.rules);
      actor.joints = std::move(moved->joints);
      actor.axes = moved->axes;
      actor.unit = head->centimetres;
    } else {
      reason = any ? head.error().message : "";
    }
  } else if (moved.error().code == Code::unsupported || moved.error().code == Code::out_of_range) {
    reason = moved.error().message;
  } else {
    return moved.error();
  }
  if (!reason.empty()) {
    Result<FileActor> named = actor_by_names(file, nodes, options);
    if (!named) return named.error();
    actor = std::move(*named);
    actor.notes.push_back(
        "its meshes cannot be looked at, so it is moved by the names of its shapes and bones, and "
        "lips may close less exactly (" +
        reason + ")");
  }
  if (actor.rig.shapes.empty()) {
    return make_error(Code::not_found,
                      advice_on_names(actor.unknown) +
                          ". So nothing in this file can speak; with --points LIST a head is made "
                          "of it that can");
  }
  return actor;
}

std::vector<std::size_t> shapes_of_targets(const File& file, const FileActor& actor,
                                           std::size_t mesh) {
  const std::vector<std::vector<std::string>>& names = actor.shape_names;
  const Json& primitive = first_primitive(file, mesh);
  std::vector<std::size_t> shapes(target_count(primitive), kNoNode);
  // Of several names of one shape in a mesh the first one shows it: all of them would add up.
  std::vector<std::pair<std::size_t, std::size_t>> taken(names.size(), {kNoNode, kNoNode});
  for (std::size_t t = 0; t < shapes.size(); ++t) {
    const std::string name = target_name(file, actor.expressions, mesh, primitive, t);
    for (std::size_t s = 0; s < names.size(); ++s) {
      const auto place = std::find(names[s].begin(), names[s].end(), name);
      if (place == names[s].end()) continue;
      const auto rank = std::size_t(place - names[s].begin());
      if (rank >= taken[s].first) continue;
      if (taken[s].second != kNoNode) shapes[taken[s].second] = kNoNode;
      taken[s] = {rank, t};
      shapes[t] = s;
    }
  }
  return shapes;
}

}  // namespace animeme::gltf
