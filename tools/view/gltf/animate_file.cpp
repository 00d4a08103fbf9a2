#include "tools/view/gltf/animate_file.h"

#include <new>
#include <set>

#include "tools/view/gltf/detail/clip_names.h"
#include "tools/view/gltf/detail/file_actor.h"
#include "tools/view/gltf/detail/file_edit.h"
#include "tools/view/gltf/detail/file_motion.h"

namespace animeme::gltf {
namespace {

constexpr const char* kAudio = "KHR_audio_emitter";

// A sound that can be heard everywhere in the scene, once somebody starts it.
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
    motion.add(clip.clip, name, clip.audio, [&](double done) {
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
