#include "tools/view/gltf/detail/morphs.h"

#include <algorithm>

#include "fap/arkit.h"
#include "fap/head/detail/normals.h"
#include "fap/head/shapes.h"
#include "fap/tables.h"

namespace animeme::gltf {
namespace {

using head::Vec3;

constexpr float kFull = 1024;

std::vector<Vec3> moved(const head::Rig& rig, const head::Pose& pose, std::size_t part) {
  return pose.positions[part].empty() ? rig.parts[part].positions : pose.positions[part];
}

// What differs between two poses. Lids and lips do not move along lines, so the two ends count.
Morph difference(const head::Rig& rig, const head::Pose& rest, const head::Pose& full, float scale,
                 const GlbOptions& options, std::string name) {
  Morph morph{std::move(name), {}};
  for (std::size_t part = 0; part < morph.parts.size(); ++part) {
    if (full.positions[part].empty()) continue;
    const std::vector<Vec3> from = moved(rig, rest, part);
    const std::vector<Vec3>& to = full.positions[part];
    PartMove& move = morph.parts[part];
    for (std::size_t v = 0; v < to.size(); ++v) {
      const Vec3 step = (to[v] - from[v]) * scale;
      if (head::length(step) < options.smallest_move) continue;
      move.vertices.push_back(std::uint32_t(v));
      move.moves.push_back(step);
      if (!options.normals) continue;
      move.turns.push_back((full.normals[part][v] - rest.normals[part][v]) * scale);
    }
  }
  return morph;
}

bool moves_anything(const Morph& morph) {
  for (const PartMove& move : morph.parts) {
    if (!move.vertices.empty()) return true;
  }
  return false;
}

// The shapes that a head was modelled with, as they are.
std::vector<Morph> own_shapes(const head::Rig& rig, const GlbOptions& options) {
  std::vector<Morph> morphs;
  for (const head::ShapeControl& shape : rig.shapes) morphs.push_back({shape.name, {}});
  for (const head::Target& target : rig.targets) {
    if (target.control < head::kFirstShape) continue;
    Morph& morph = morphs[std::size_t(target.control - head::kFirstShape)];
    const auto part = std::size_t(target.part);
    PartMove& move = morph.parts[part];
    std::vector<Vec3> moved = rig.parts[part].positions;
    for (std::size_t k = 0; k < target.vertices.size(); ++k) {
      const Vec3 step = target.deltas[k] * target.units(head::kFullShape);
      moved[target.vertices[k]] += step;
      if (head::length(step) < options.smallest_move) continue;
      move.vertices.push_back(target.vertices[k]);
      move.moves.push_back(step);
    }
    if (!options.normals) continue;
    std::vector<Vec3> normals;
    head::detail::smooth_normals(moved, rig.parts[part].triangles, normals);
    for (const std::uint32_t v : move.vertices) {
      move.turns.push_back(normals[v] - rig.parts[part].normals[v]);
    }
  }
  return morphs;
}

// A bone does it: gaze and the turn of the head.
bool is_bone(int fap) { return (fap >= 23 && fap <= 28) || (fap >= 48 && fap <= 50); }

std::vector<std::vector<float>> own_weights(const head::Rig& rig, const fap::Sequence& clip,
                                            const std::vector<Morph>& morphs,
                                            std::span<const fap::VisemeWeights> visemes) {
  std::vector<std::size_t> controls;
  for (const Morph& morph : morphs) {
    const auto shape =
        std::find_if(rig.shapes.begin(), rig.shapes.end(),
                     [&](const head::ShapeControl& known) { return known.name == morph.name; });
    controls.push_back(head::kFirstShape + std::size_t(shape - rig.shapes.begin()));
  }
  std::vector<std::vector<float>> rows;
  for (const fap::Frame& frame : clip.frames) {
    head::PoseOptions options;
    if (rows.size() < visemes.size()) options.visemes = visemes[rows.size()];
    const head::ControlValues values = head::control_values(rig, frame, options);
    rows.emplace_back();
    for (const std::size_t control : controls) {
      rows.back().push_back(values[control] / head::kFullShape);
    }
  }
  return rows;
}

}  // namespace

std::vector<Morph> make_morphs(const head::Rig& rig, const GlbOptions& options) {
  std::vector<Morph> morphs;
  const auto add = [&](Morph morph) {
    if (moves_anything(morph)) morphs.push_back(std::move(morph));
  };
  if (!rig.shapes.empty()) {
    for (Morph& morph : own_shapes(rig, options)) add(std::move(morph));
    return morphs;
  }
  const head::Pose rest = head::pose(rig, {});
  if (options.morphs == MorphNames::arkit) {
    for (std::size_t shape = 0; shape < std::size_t(fap::kArkitShapeCount); ++shape) {
      fap::ArkitFrame weights{};
      // Lips that are shut cannot show mouthClose: it brings those of an open jaw together.
      const bool closes = fap::kArkitNames[shape] == "mouthClose";
      if (closes) weights[std::size_t(*fap::find_arkit("jawOpen"))] = 1;
      const head::Pose before =
          closes ? head::pose(rig, fap::arkit_to_fap(weights, fap::kAllArkit)) : rest;
      weights[shape] = 1;
      const fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
      add(difference(rig, before, head::pose(rig, frame), 1, options,
                     std::string(fap::kArkitNames[shape])));
    }
    return morphs;
  }
  const head::PoseOptions free{.contact = false};
  const head::Pose free_rest = head::pose(rig, {}, free);
  for (int number = fap::kFirstLowLevel; number <= fap::kFapCount; ++number) {
    if (is_bone(number)) continue;
    // Lids slide: the closed lid is the one that has to be right. All else is linear.
    fap::Frame frame;
    frame.set(number, std::int32_t(kFull));
    add(difference(rig, free_rest, head::pose(rig, frame, free), 1, options,
                   std::string(fap::info(number).name)));
  }
  return morphs;
}

std::vector<std::vector<float>> morph_weights(const head::Rig& rig, const fap::Sequence& clip,
                                              const std::vector<Morph>& morphs, MorphNames names,
                                              std::span<const fap::VisemeWeights> visemes) {
  std::vector<std::vector<float>> rows;
  if (!rig.shapes.empty()) return own_weights(rig, clip, morphs, visemes);
  fap::ArkitFitter fitter;
  for (const fap::Frame& frame : clip.frames) {
    const fap::Frame low = head::low_level(frame);
    std::vector<float> row;
    if (names == MorphNames::arkit) {
      const fap::ArkitFrame weights = fitter.fit(low);
      for (const Morph& morph : morphs) {
        row.push_back(float(weights[std::size_t(*fap::find_arkit(morph.name))]));
      }
    } else {
      for (const Morph& morph : morphs) {
        row.push_back(float(low.value[std::size_t(*fap::find_fap(morph.name))]) / kFull);
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace animeme::gltf
