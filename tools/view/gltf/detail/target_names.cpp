#include "tools/view/gltf/detail/target_names.h"

#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace {

std::string own_name(const File& file, const Json& mesh, const Json& primitive,
                     std::size_t target) {
  for (const Json* from : {&member(mesh, "extras"), &member(primitive, "extras")}) {
    const std::span<const Json> names = list(*from, "targetNames");
    if (target < names.size() && names[target].is_string()) return text_or(names[target]);
  }
  const std::span<const Json> targets = list(primitive, "targets");
  const auto accessor =
      target < targets.size() ? whole(member(targets[target], "POSITION")) : std::nullopt;
  const std::string name =
      accessor ? text_or(member(file.entry("accessors", *accessor), "name")) : "";
  return name.empty() ? "target " + std::to_string(target) : name;
}

}  // namespace

std::string own_target_name(const File& file, std::size_t mesh, std::size_t target) {
  const Json& entry = file.entry("meshes", mesh);
  const std::span<const Json> primitives = list(entry, "primitives");
  static const Json none;
  return own_name(file, entry, primitives.empty() ? none : primitives.front(), target);
}

std::string target_name(const File& file, const TargetNames& expressions, std::size_t mesh,
                        const Json& primitive, std::size_t target) {
  std::string name = own_name(file, file.entry("meshes", mesh), primitive, target);
  const auto expression = expressions.find({mesh, target});
  if (expression == expressions.end() || meaning_of(name)) return name;
  return expression->second;
}

}  // namespace animeme::gltf
