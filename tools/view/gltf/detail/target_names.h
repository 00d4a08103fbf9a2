// What the morph targets of a mesh are called.
#pragma once

#include <string>

#include "tools/view/gltf/detail/file.h"
#include "tools/view/gltf/detail/vrm.h"

namespace animeme::gltf {

/// The name that a morph target has itself, by its mesh's first primitive; see target_name().
std::string own_target_name(const File& file, std::size_t mesh, std::size_t target);

/// Its own name if that is known; else that of the expression of a VRM file (vrm_expressions())
/// which it shows. Own names: of the mesh, as nearly all programs write them; of the primitive
/// (UniGLTF); of the accessor; else "target 7".
std::string target_name(const File& file, const TargetNames& expressions, std::size_t mesh,
                        const Json& primitive, std::size_t target);

}  // namespace animeme::gltf
