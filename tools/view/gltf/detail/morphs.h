// Morph targets of a head and their weights over a clip.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fap/head/rig.h"
#include "tools/view/gltf/glb.h"

namespace animeme::gltf {

/// Moves of a part's vertices, cm; those that stay are left out.
struct PartMove {
  std::vector<std::uint32_t> vertices;  ///< ascending
  std::vector<head::Vec3> moves;
  std::vector<head::Vec3> turns;  ///< changes of the normals; empty: not wanted
};

struct Morph {
  std::string name;
  std::array<PartMove, head::kPartCount> parts;
};

/// All targets that move anything beside bones. Of a rig with shapes: these, by their names.
std::vector<Morph> make_morphs(const head::Rig& rig, const GlbOptions& options);

/// Weights of the targets for each frame of the clip, frame by frame. `visemes`: see GlbOptions.
std::vector<std::vector<float>> morph_weights(const head::Rig& rig, const fap::Sequence& clip,
                                              const std::vector<Morph>& morphs, MorphNames names,
                                              std::span<const fap::VisemeWeights> visemes);

}  // namespace animeme::gltf
