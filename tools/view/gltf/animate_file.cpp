#include "tools/view/gltf/animate_file.h"

#include <algorithm>
#include <new>
#include <set>

#include "tools/view/gltf/detail/clip_keys.h"
#include "tools/view/gltf/detail/clip_names.h"
#include "tools/view/gltf/detail/file_actor.h"
#include "tools/view/gltf/detail/file_edit.h"

namespace animeme::gltf {

namespace {

// The nodes of a file that move.
class FileMotion {
 public:
  // All of these have to outlive it. Nodes that cannot be animated as they are get other members,
  // or are left out, with a note.
  FileMotion(FileEdit& edit, const std::vector<Node>& nodes, const FileActor& actor,
             std::vector<std::string>& notes);

  std::size_t meshes() const { return meshes_.size(); }
  std::size_t bones() const { return bones_.size(); }

  // One more animation, with this name.
  void add(const NamedClip& clip, const std::string& name,
           const std::function<void(double)>& progress);

 private:
  struct MovedMesh {
    std::size_t node = 0;
    std::vector<std::size_t> shapes;  // of each target; kNoNode: it stays at rest
    std::vector<float> rest;          // weights
  };
  struct MovedBone {
    std::size_t node = 0;
    Bone bone = Bone::neck;
    double share = 1;
    NodeTurn turn;
  };
  void find_meshes();
  void find_bones(std::vector<std::string>& notes);
  void add_bone(std::size_t node, Bone bone, double share, std::vector<std::string>& notes);
  void add_channel(Json& animation, std::size_t times, std::size_t values, std::size_t node,
                   const char* path);
  void add_weights(Json& animation, std::size_t times,
                   const std::vector<std::vector<float>>& weights);
  void add_turns(Json& animation, std::size_t times, const ClipKeys& keys);

  FileEdit& edit_;
  const std::vector<Node>& nodes_;
  const FileActor& actor_;
  std::vector<MovedMesh> meshes_;
  std::vector<MovedBone> bones_;
};

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

FileMotion::FileMotion(FileEdit& edit, const std::vector<Node>& nodes, const FileActor& actor,
                       std::vector<std::string>& notes)
    : edit_(edit), nodes_(nodes), actor_(actor) {
  find_meshes();
  find_bones(notes);
}

void FileMotion::find_meshes() {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!nodes_[i].mesh) continue;
    MovedMesh mesh;
    mesh.node = i;
    mesh.shapes = shapes_of_targets(edit_.file(), actor_, *nodes_[i].mesh);
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

void FileMotion::add(const NamedClip& clip, const std::string& name,
                     const std::function<void(double)>& progress) {
  const ClipKeys keys = keys_of_clip(actor_.rig, clip.clip, clip.visemes, progress);
  const std::size_t input = edit_.floats(keys.times, "SCALAR", true);
  Json animation = {{"name", name}, {"channels", Json::array()}, {"samplers", Json::array()}};
  add_weights(animation, input, keys.weights);
  add_turns(animation, input, keys);
  if (!clip.audio.empty()) animation["extras"] = {{"audio", clip.audio}};
  edit_.add("animations", animation);
}

constexpr const char* kAudio = "KHR_audio_emitter";

// A global audio source, which the application starts.
void add_sound(FileEdit& edit, const FileSound& sound, const std::string& name) {
  const std::size_t audio = edit.add_to_extension(
      kAudio, "audio", {{"bufferView", edit.view(sound.bytes)}, {"mimeType", sound.type}});
  const std::size_t source =
      edit.add_to_extension(kAudio, "sources", {{"name", name}, {"audio", audio}});
  const std::size_t emitter = edit.add_to_extension(
      kAudio, "emitters", {{"name", name}, {"type", "global"}, {"sources", {source}}});
  const std::size_t scene = whole_or(member(edit.file().root, "scene"), 0);
  if (scene < list(edit.file().root, "scenes").size()) {
    edit.add_to_scene(scene, kAudio, "emitters", emitter);
  }
  edit.use(kAudio);
}

Result<AnimatedFile> animated(std::span<const std::uint8_t> bytes, std::span<const NamedClip> clips,
                              const AnimateOptions& options) {
  auto edit = FileEdit::open(bytes, options.reading.limits);
  if (!edit) return edit.error();
  const auto nodes = read_nodes(edit->file());
  if (!nodes) return nodes.error();
  auto actor = file_actor(bytes, edit->file(), *nodes, options.reading);
  if (!actor) return actor.error();
  actor->rig.mouth_gain = options.mouth_gain;
  AnimatedFile out;
  out.notes = std::move(actor->notes);
  FileMotion motion(*edit, *nodes, *actor, out.notes);
  out.shapes = actor->shape_names.size();
  out.meshes = motion.meshes();
  out.bones = motion.bones();
  std::set<std::string> taken;
  for (const Json& animation : list(edit->file().root, "animations")) {
    taken.insert(text_or(member(animation, "name")));
  }
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const NamedClip& clip = clips[i];
    const std::string name = free_name(clip.name, taken);
    motion.add(clip, name, [&](double done) {
      if (options.progress) options.progress((double(i) + done) / double(clips.size()));
    });
    if (clip.sound) add_sound(*edit, *clip.sound, name);
    out.names.push_back(name);
  }
  auto file = edit->finish();
  if (!file) return file.error();
  out.front = std::move(file->front);
  out.middle = file->middle;
  out.back = std::move(file->back);
  return out;
}

}  // namespace

Result<AnimatedFile> animate_file(std::span<const std::uint8_t> bytes,
                                  std::span<const NamedClip> clips, const AnimateOptions& options) {
  if (!is_motion(clips)) {
    return make_error(Code::invalid_argument, "there is no motion to export");
  }
  try {
    return animated(bytes, clips, options);
  } catch (const std::bad_alloc&) {
    return make_error(Code::out_of_range,
                      "there is not enough memory for this file: reduce its meshes and pictures");
  }
}

}  // namespace animeme::gltf
