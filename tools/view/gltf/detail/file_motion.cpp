#include "tools/view/gltf/detail/file_motion.h"

#include <algorithm>
#include <cmath>

#include "tools/view/gltf/detail/target_names.h"

namespace animeme::gltf {
namespace {

Json number_list(std::span<const double> values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(value);
  return out;
}

// Without its braces.
std::string members_of(const LocalPlace& place) {
  const std::string text = sorted_text({{"translation", number_list(place.translation)},
                                        {"rotation", number_list(place.rotation)},
                                        {"scale", number_list(place.scale)}});
  return text.substr(1, text.size() - 2);
}

std::vector<float> resting_weights(const File& file, const Node& node, std::size_t number,
                                   std::size_t count) {
  for (const Json* from : {&file.entry("nodes", number), &file.entry("meshes", *node.mesh)}) {
    if (const auto given = numbers(member(*from, "weights"), count)) {
      return {given->begin(), given->end()};
    }
  }
  return std::vector<float>(count, 0);
}

}  // namespace

FileMotion::FileMotion(FileEdit& edit, const std::vector<Node>& nodes, const FileActor& actor,
                       std::vector<std::string>& notes)
    : edit_(edit), nodes_(nodes), actor_(actor) {
  find_meshes();
  find_bones(notes);
}

void FileMotion::find_meshes() {
  const TargetNames expressions = vrm_expressions(edit_.file(), nodes_);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!nodes_[i].mesh) continue;
    MovedMesh mesh;
    mesh.node = i;
    mesh.shapes = shapes_of_targets(edit_.file(), expressions, *nodes_[i].mesh, actor_.shape_names);
    const bool any = std::any_of(mesh.shapes.begin(), mesh.shapes.end(),
                                 [](std::size_t shape) { return shape != kNoNode; });
    if (!any) continue;
    mesh.rest = resting_weights(edit_.file(), nodes_[i], i, mesh.shapes.size());
    meshes_.push_back(std::move(mesh));
  }
}

void FileMotion::find_bones(std::vector<std::string>& notes) {
  const HeadJoints& joints = actor_.joints;
  const auto shown = [&](head::Part part) { return actor_.rig.shown_by_shapes[std::size_t(part)]; };
  const double share = 1 / (double(joints.neck.size()) + 1);
  for (const std::size_t node : joints.neck) add_bone(node, Bone::neck, share, notes);
  add_bone(joints.head, Bone::neck, share, notes);
  if (!shown(head::Part::left_eye)) add_bone(joints.eyes[0], Bone::left_eye, 1, notes);
  if (!shown(head::Part::right_eye)) add_bone(joints.eyes[1], Bone::right_eye, 1, notes);
  if (!shown(head::Part::lower_teeth) && !shown(head::Part::tongue)) {
    add_bone(joints.jaw, Bone::jaw, 1, notes);
  }
}

void FileMotion::add_bone(std::size_t node, Bone bone, double share,
                          std::vector<std::string>& notes) {
  if (node >= nodes_.size()) return;
  const auto place = local_place(edit_.file().entry("nodes", node));
  if (!place) {
    notes.push_back("\"" + nodes_[node].name +
                    "\" cannot be rotated: its matrix has shear, which animations do not support");
    return;
  }
  if (place->of_matrix) {
    edit_.replace_matrix(node, members_of(*place));
    notes.push_back("\"" + nodes_[node].name +
                    "\" has translation, rotation and scale now in the place of its matrix, which "
                    "may not be animated");
  }
  const std::size_t parent = nodes_[node].parent;
  bones_.push_back({node, bone, share,
                    NodeTurn(*place, parent == kNoNode ? Affine{} : nodes_[parent].world,
                             actor_.axes, actor_.unit)});
}

void FileMotion::add_channel(Json& animation, std::size_t times, std::size_t values,
                             std::size_t node, const char* path) {
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back(
      {{"input", times}, {"output", values}, {"interpolation", "LINEAR"}});
}

void FileMotion::add_weights(Json& animation, std::size_t times,
                             const std::vector<std::vector<float>>& weights) {
  std::vector<std::pair<std::vector<float>, std::size_t>> written;  // meshes are often shared
  for (const MovedMesh& mesh : meshes_) {
    std::vector<float> values;
    values.reserve(weights.size() * mesh.shapes.size());
    for (const std::vector<float>& frame : weights) {
      for (std::size_t t = 0; t < mesh.shapes.size(); ++t) {
        values.push_back(mesh.shapes[t] == kNoNode ? mesh.rest[t] : frame[mesh.shapes[t]]);
      }
    }
    const auto same = std::find_if(written.begin(), written.end(),
                                   [&](const auto& entry) { return entry.first == values; });
    if (same == written.end()) {
      written.emplace_back(values, edit_.floats(values, "SCALAR"));
      add_channel(animation, times, written.back().second, mesh.node, "weights");
    } else {
      add_channel(animation, times, same->second, mesh.node, "weights");
    }
  }
}

void FileMotion::add_turns(Json& animation, std::size_t times, const ClipKeys& keys) {
  const auto rest = bones_of(actor_.rig, head::pose(actor_.rig, {}));
  for (const MovedBone& bone : bones_) {
    std::vector<float> places;
    bool shifted = false;
    for (const auto& frame : keys.bones) {
      const auto which = std::size_t(bone.bone);
      head::Vec3 shift = (frame[which].place - rest[which].place) * (1 / kMetres);
      if (bone.bone == Bone::neck) shift = {};
      shifted = shifted || head::length(shift) > 1e-4f;
      for (const double part : bone.turn.translation(shift)) places.push_back(float(part));
    }
    if (turns(keys, bone.bone)) {
      const auto values = rotation_keys(bone.turn, keys, bone.bone, bone.share);
      add_channel(animation, times, edit_.floats(values, "VEC4"), bone.node, "rotation");
    }
    if (shifted) {
      add_channel(animation, times, edit_.floats(places, "VEC3"), bone.node, "translation");
    }
  }
}

void FileMotion::add(const fap::Sequence& clip, const std::string& name, const std::string& audio,
                     const std::function<void(double)>& progress) {
  const ClipKeys keys = keys_of_clip(actor_.rig, clip, progress);
  const std::size_t input = edit_.floats(keys.times, "SCALAR", true);
  Json animation = {{"name", name}, {"channels", Json::array()}, {"samplers", Json::array()}};
  add_weights(animation, input, keys.weights);
  add_turns(animation, input, keys);
  if (!audio.empty()) animation["extras"] = {{"audio", audio}};
  edit_.add("animations", animation);
}

}  // namespace animeme::gltf
