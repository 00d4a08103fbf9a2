// Parts of the actor in files that tests write.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/support/gltf_writer.h"
#include "tests/view/gltf/actor.h"

namespace animeme::gltf {

/// A morph target and the pose that it is.
struct NamedPose {
  std::string name;
  fap::Frame frame;
};

inline std::vector<float> floats(const std::vector<head::Vec3>& values) {
  std::vector<float> out;
  for (const head::Vec3& v : values) out.insert(out.end(), {v.x, v.y, v.z});
  return out;
}

/// Adds a node with a mesh called `mesh_name`: a part of the actor. Morph targets go with the skin.
inline nlohmann::json add_actor_part(test::GltfWriter& file, head::Part part,
                                     const std::string& mesh_name,
                                     const std::vector<NamedPose>& poses,
                                     std::optional<int> material = std::nullopt) {
  const head::Rig& rig = actor().rig;
  const head::Rig::Shape& shape = rig.parts[std::size_t(part)];
  std::vector<std::uint32_t> corners;
  for (const head::Triangle& t : shape.triangles) corners.insert(corners.end(), t.begin(), t.end());
  nlohmann::json primitive = {
      {"attributes", {{"POSITION", file.accessor(floats(shape.positions), "VEC3")}}},
      {"indices", file.accessor(corners, "SCALAR")}};
  if (material) primitive["material"] = *material;
  nlohmann::json mesh = {{"name", mesh_name}};
  for (const auto& [name, frame] : poses) {
    if (part != head::Part::skin) break;
    std::vector<head::Vec3> moves = head::pose(rig, frame).positions[0];
    for (std::size_t v = 0; v < moves.size(); ++v) moves[v] -= shape.positions[v];
    primitive["targets"].push_back({{"POSITION", file.accessor(floats(moves), "VEC3")}});
    mesh["extras"]["targetNames"].push_back(name);
  }
  mesh["primitives"] = nlohmann::json::array({primitive});
  return file.add("nodes", {{"mesh", file.add("meshes", mesh)}});
}

}  // namespace animeme::gltf
