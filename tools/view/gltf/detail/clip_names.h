// What animations are called.
#pragma once

#include <set>
#include <span>
#include <string>

#include "tools/view/gltf/animate_file.h"

namespace animeme::gltf {

/// True if there is a clip, and in each a frame.
bool is_motion(std::span<const NamedClip> clips);

/// A name that no animation has yet; it is taken then.
std::string free_name(const std::string& wanted, std::set<std::string>& taken);

}  // namespace animeme::gltf
