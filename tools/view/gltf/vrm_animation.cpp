#include "tools/view/gltf/vrm_animation.h"

#include <algorithm>
#include <map>
#include <new>
#include <set>
#include <string>
#include <vector>

#include "tools/view/gltf/detail/clip_keys.h"
#include "tools/view/gltf/detail/clip_names.h"
#include "tools/view/gltf/detail/file_actor.h"
#include "tools/view/gltf/detail/file_edit.h"
#include "tools/view/gltf/detail/glb_buffer.h"

namespace animeme::gltf {

namespace {

// An expression that shows one shape of a head and nothing else.
struct ShownShape {
  std::string name;       // of the expression
  bool custom = false;    // not one of VRM's own
  std::size_t shape = 0;  // of FileActor::shape_names
  double weight = 1;      // of the shape at an expression of 1
};

// The shape of the expression `json`; nothing if it shows none, or more than that.
std::optional<ShownShape> shown_shape(const Json& json, const std::vector<Node>& nodes,
                                      const std::vector<std::vector<std::size_t>>& targets) {
  std::optional<ShownShape> shown;
  for (const Json& bind : list(json, "morphTargetBinds")) {
    const double weight = number_or(member(bind, "weight"), 0);
    if (weight < 0.01) continue;
    const std::size_t node = whole_or(member(bind, "node"), kNoNode);
    const std::size_t target = whole_or(member(bind, "index"), kNoNode);
    if (node >= nodes.size() || target >= targets[node].size()) return std::nullopt;
    const std::size_t shape = targets[node][target];
    if (shape == kNoNode || (shown && shown->shape != shape)) return std::nullopt;
    if (!shown) shown = ShownShape{{}, false, shape, weight};
  }
  return shown;
}

// For each shape the first of its expressions, VRM's own before others; none of the gaze.
std::vector<ShownShape> shown_shapes(const File& file, const std::vector<Node>& nodes,
                                     const FileActor& actor) {
  std::vector<std::vector<std::size_t>> targets;
  for (const Node& node : nodes) {
    targets.emplace_back();
    if (!node.mesh) continue;
    targets.back() = shapes_of_targets(file, actor, *node.mesh);
  }
  std::vector<ShownShape> all;
  std::set<std::size_t> taken;
  for (const bool custom : {false, true}) {
    const Json& of_kind =
        member(file.root, "extensions", "VRMC_vrm", "expressions", custom ? "custom" : "preset");
    if (!of_kind.is_object()) continue;
    for (const auto& [name, json] : of_kind.items()) {
      static const std::set<std::string> of_gaze = {"lookUp", "lookDown", "lookLeft", "lookRight"};
      if (of_gaze.count(name) > 0) continue;
      std::optional<ShownShape> shown = shown_shape(json, nodes, targets);
      if (!shown || !taken.insert(shown->shape).second) continue;
      shown->name = name;
      shown->custom = custom;
      all.push_back(*shown);
    }
  }
  return all;
}

// The bones of a human, without eyes, which animations may not turn: nodes by name.
std::map<std::string, std::size_t> human_bones(const File& file, const std::vector<Node>& nodes) {
  std::map<std::string, std::size_t> bones;
  std::set<std::size_t> taken;
  const Json& human = member(file.root, "extensions", "VRMC_vrm", "humanoid", "humanBones");
  if (!human.is_object()) return bones;
  for (const auto& [name, bone] : human.items()) {
    const std::size_t node = whole_or(member(bone, "node"), kNoNode);
    if (name == "leftEye" || name == "rightEye" || node >= nodes.size()) continue;
    if (taken.insert(node).second) bones[name] = node;
  }
  return bones;
}

constexpr const char* kVrmAnimation = "VRMC_vrm_animation";

// The file while it is made.
class AnimationWriter {
 public:
  AnimationWriter(const std::vector<Node>& nodes, const FileActor& actor,
                  std::map<std::string, std::size_t> bones, std::vector<ShownShape> shown)
      : nodes_(nodes), actor_(actor), bones_(std::move(bones)), shown_(std::move(shown)) {
    add_skeleton();
    Json& expressions = extension_["expressions"];
    for (const ShownShape& shape : shown_) {
      expressions[shape.custom ? "custom" : "preset"][shape.name] = {{"node", out_.size()}};
      first_expression_ = std::min(first_expression_, out_.size());
      add_root({{"name", "expression " + shape.name}});
    }
    // Where shapes show the gaze, and expressions these, eyes must not turn twice.
    gaze_ = std::none_of(shown_.begin(), shown_.end(), [&](const ShownShape& shape) {
      return actor_.rig.shapes[shape.shape].name.rfind("eyeLook", 0) == 0;
    });
    if (gaze_) {
      extension_["lookAt"] = {{"node", out_.size()}};
      add_root({{"name", "gaze"}});
    }
  }

  void add(const NamedClip& clip, const std::string& name,
           const std::function<void(double)>& progress) {
    const ClipKeys keys = keys_of_clip(actor_.rig, clip.clip, clip.visemes, progress);
    animation_ = {{"name", name}, {"channels", Json::array()}, {"samplers", Json::array()}};
    if (!clip.audio.empty()) animation_["extras"] = {{"audio", clip.audio}};
    times_ = buffer_.floats(keys.times, 1, BufferUse::other, true);
    const NodeTurn upright({}, {}, actor_.axes, actor_.unit);
    const double share = bones_.count("neck") > 0 ? 0.5 : 1;
    for (const char* bone : {"neck", "head"}) {
      if (bones_.count(bone) == 0 || !turns(keys, Bone::neck)) continue;
      channel(node_of_.at(bone), "rotation",
              buffer_.floats(rotation_keys(upright, keys, Bone::neck, share), 4, BufferUse::other));
    }
    for (std::size_t i = 0; i < shown_.size(); ++i) {
      std::vector<head::Vec3> places;
      for (const std::vector<float>& weights : keys.weights) {
        const double weight = double(weights[shown_[i].shape]) / shown_[i].weight;
        places.push_back({float(std::clamp(weight, 0.0, 1.0)), 0, 0});
      }
      channel(first_expression_ + i, "translation",
              buffer_.vectors(places, BufferUse::other, false));
    }
    if (gaze_) add_gaze(clip.clip, upright);
    animations_.push_back(std::move(animation_));
  }

  Result<Bytes> finish() {
    const Json root = {{"asset", {{"version", "2.0"}, {"generator", "Animeme"}}},
                       {"extensionsUsed", {kVrmAnimation}},
                       {"extensions", {{kVrmAnimation, extension_}}},
                       {"scene", 0},
                       {"scenes", {{{"nodes", roots_}}}},
                       {"nodes", out_},
                       {"animations", animations_},
                       {"accessors", buffer_.accessors},
                       {"bufferViews", buffer_.views}};
    return buffer_.file(root);
  }

 private:
  void add_root(Json node) {
    roots_.push_back(out_.size());
    out_.push_back(std::move(node));
  }

  // The bones without their turns: VRM 1.0 rests in a T pose, and so has this file to.
  void add_skeleton() {
    std::map<std::size_t, std::size_t> numbers;
    for (const auto& [name, node] : bones_) {
      numbers[node] = node_of_[name] = out_.size();
      extension_["humanoid"]["humanBones"][name] = {{"node", out_.size()}};
      out_.push_back({{"name", name}});
    }
    for (const auto& [name, node] : bones_) {
      std::size_t parent = nodes_[node].parent;
      while (parent != kNoNode && numbers.count(parent) == 0) parent = nodes_[parent].parent;
      head::Vec3d place = nodes_[node].world.origin();
      if (parent == kNoNode) {
        roots_.push_back(node_of_[name]);
      } else {
        place = place - nodes_[parent].world.origin();
        out_[numbers[parent]]["children"].push_back(node_of_[name]);
      }
      out_[node_of_[name]]["translation"] = {float(place.x), float(place.y), float(place.z)};
    }
  }

  void channel(std::size_t node, const char* path, int values) {
    animation_["channels"].push_back(
        {{"sampler", animation_["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation_["samplers"].push_back(
        {{"input", times_}, {"output", values}, {"interpolation", "LINEAR"}});
  }

  // Where both eyes look, seen from the head: the middle of the two.
  void add_gaze(const fap::Sequence& clip, const NodeTurn& upright) {
    std::vector<float> values;
    for (const fap::Frame& frame : clip.frames) {
      const auto middle = [&](std::size_t left) {
        return float(frame.value[left] + frame.value[left + 1]) * 0.5e-5f;
      };
      const head::Transform t = head::rotation_about({}, middle(25), middle(23), 0);
      const auto row = [](head::Vec3 v) { return std::array<double, 3>{v.x, v.y, v.z}; };
      const auto q = quaternion_of({row(t.row_x), row(t.row_y), row(t.row_z)});
      for (const double part : upright.rotation(q)) values.push_back(float(part));
    }
    channel(extension_["lookAt"]["node"].get<std::size_t>(), "rotation",
            buffer_.floats(values, 4, BufferUse::other));
  }

  const std::vector<Node>& nodes_;
  const FileActor& actor_;
  std::map<std::string, std::size_t> bones_, node_of_;
  std::vector<ShownShape> shown_;
  std::size_t first_expression_ = kNoNode;
  bool gaze_ = true;
  int times_ = 0;
  GlbBuffer buffer_;
  Json extension_ = {{"specVersion", "1.0"}};
  Json out_ = Json::array(), roots_ = Json::array(), animations_ = Json::array(), animation_;
};

// The head as its expressions move it: those that have all shapes of ARKit, or visemes.
Result<FileActor> actor_of_expressions(std::span<const std::uint8_t> bytes, const File& file,
                                       const std::vector<Node>& nodes, ReadOptions reading) {
  auto actor = file_actor(bytes, file, nodes, reading);
  if (!actor || reading.mouth != MouthShapes::automatic) return actor;
  const std::size_t shown = shown_shapes(file, nodes, *actor).size();
  if (2 * shown > actor->shape_names.size()) return actor;
  reading.mouth = MouthShapes::visemes;
  auto other = file_actor(bytes, file, nodes, reading);
  if (other && shown_shapes(file, nodes, *other).size() > shown) return other;
  return actor;
}

Result<VrmAnimation> vrm_animated(std::span<const std::uint8_t> bytes,
                                  std::span<const NamedClip> clips, const AnimateOptions& options) {
  const auto edit = FileEdit::open(bytes, options.reading.limits);
  if (!edit) return edit.error();
  const File& file = edit->file();
  const auto nodes = read_nodes(file);
  if (!nodes) return nodes.error();
  auto bones = human_bones(file, *nodes);
  if (bones.count("head") == 0) {
    return make_error(Code::unsupported,
                      "a .vrma is for avatars of VRM 1.0, which this is not: write a .glb or .vrm "
                      "instead");
  }
  auto actor = actor_of_expressions(bytes, file, *nodes, options.reading);
  if (!actor) return actor.error();
  actor->rig.mouth_gain = options.mouth_gain;
  const std::vector<ShownShape> shown = shown_shapes(file, *nodes, *actor);
  if (shown.empty()) {
    return make_error(
        Code::not_found,
        "no expression shows a shape that is known (aa, ih, ou, blinkLeft, jawOpen), so "
        "no .vrma can move it: write a .glb or .vrm instead");
  }
  VrmAnimation out;
  out.notes = std::move(actor->notes);
  std::set<std::size_t> moved;
  for (const ShownShape& shape : shown) {
    out.expressions.push_back(shape.name);
    moved.insert(shape.shape);
  }
  std::string resting;
  for (std::size_t i = 0; i < actor->rig.shapes.size(); ++i) {
    if (moved.count(i) == 0) resting += (resting.empty() ? "" : ", ") + actor->rig.shapes[i].name;
  }
  if (!resting.empty()) {
    out.notes.push_back("shapes without an expression of their own, which stay at rest: " +
                        resting);
  }
  AnimationWriter writer(*nodes, *actor, std::move(bones), shown);
  std::set<std::string> taken;
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const std::string name = free_name(clips[i].name, taken);
    writer.add(clips[i], name, [&](double done) {
      if (options.progress) options.progress((double(i) + done) / double(clips.size()));
    });
    out.names.push_back(name);
  }
  auto file_bytes = writer.finish();
  if (!file_bytes) return file_bytes.error();
  out.file = std::move(*file_bytes);
  return out;
}

}  // namespace

Result<VrmAnimation> vrm_animation(std::span<const std::uint8_t> avatar,
                                   std::span<const NamedClip> clips,
                                   const AnimateOptions& options) {
  if (!is_motion(clips)) return make_error(Code::invalid_argument, "there is no motion to export");
  try {
    return vrm_animated(avatar, clips, options);
  } catch (const std::bad_alloc&) {
    return make_error(Code::out_of_range,
                      "there is not enough memory for this file: reduce its meshes and pictures");
  }
}

}  // namespace animeme::gltf
