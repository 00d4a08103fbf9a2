#include "tools/view/gltf/detail/clip_names.h"

#include <algorithm>

namespace animeme::gltf {

bool is_motion(std::span<const NamedClip> clips) {
  return !clips.empty() && std::all_of(clips.begin(), clips.end(), [](const NamedClip& clip) {
    return !clip.clip.frames.empty() && clip.clip.rate.valid();
  });
}

std::string free_name(const std::string& wanted, std::set<std::string>& taken) {
  const std::string base = wanted.empty() ? "talk" : wanted;
  std::string name = base;
  for (int number = 2; !taken.insert(name).second; ++number) {
    name = base + " " + std::to_string(number);
  }
  return name;
}

}  // namespace animeme::gltf
