// Materials of a file as coats.
#pragma once

#include <functional>

#include "tools/view/gltf/detail/texture.h"

namespace animeme::gltf {

/// Gives the texture that a material names.
using TextureOf = std::function<head::Texture(const Json& info, TexelKind kind)>;

/// All that is drawn of a material: glTF's own, unlit, specular, emissive strength, transmission
/// (as opacity), VRM 1.0's MToon and that of VRM 0.x. `paint` has its name, base and opacity.
head::Coat read_coat(const File& file, std::size_t material, const Paint& paint,
                     const TextureOf& texture);

}  // namespace animeme::gltf
