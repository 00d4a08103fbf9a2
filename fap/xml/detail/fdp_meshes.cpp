#include <algorithm>

#include "fap/detail/text_scanner.h"
#include "fap/head/detail/scene.h"
#include "fap/xml/detail/fdp_file.h"

namespace animeme::head::detail {
namespace {

using fap::detail::in_quotes;

// A file beside the .fdp or below: nothing else may be asked for by a file from elsewhere.
bool stays_in_folder(std::string_view name) {
  if (name.empty() || name.front() == '/' || name.front() == '\\') return false;
  if (name.find(':') != name.npos || name.find('\0') != name.npos) return false;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find_first_of("/\\"), name.size());
    if (name.substr(0, end) == "..") return false;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return true;
}

// Xface calls a mesh by the DEF name of its geometry, else FILE_0, FILE_1 ... of those without one.
Result<void> add_wrl(const std::string& file, std::string_view text, FdpFile& out) {
  const auto scene = wrl_scene(text, &out.notes);
  if (!scene) return scene.error();
  auto pieces = scene_pieces(*scene);
  if (!pieces) return pieces.error();
  int unnamed = 0;
  for (ScenePiece& scene_piece : *pieces) {
    if (!scene_piece.first_use) continue;  // Xface does not know USE
    FdpMesh mesh;
    const std::string& name = scene_piece.geometry_name;
    mesh.names = {name.empty() ? file + "_" + std::to_string(unnamed++) : name};
    mesh.place = scene_piece.place;
    Piece& piece = scene_piece.piece;
    mesh.positions = piece.mesh.positions;
    const bool shown = !piece.mesh.triangles.empty();
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      mesh.where.push_back({out.pieces.size(), shown ? v : kMissing});
    }
    if (piece.name.empty()) piece.name = mesh.names.front();
    if (shown) out.pieces.push_back(std::move(piece));
    out.meshes.push_back(std::move(mesh));
  }
  return {};
}

// The groups and objects of an .obj: each of them has all vertices of the file in Xface.
std::vector<std::string> group_names(std::string_view text) {
  std::vector<std::string> names = {"base_mesh"};
  fap::detail::TextScanner in(text);
  while (in.to_content()) {
    const std::string_view key = in.token();
    if (key == "g" || key == "o") {
      const std::string_view name = in.token();
      if (!name.empty()) names.emplace_back(name);
    }
    in.rest_of_line();
  }
  return names;
}

Result<void> add_obj(std::string_view text, FdpFile& out) {
  Result<ObjFile> obj = read_obj(text);
  if (!obj) return obj.error();
  FdpMesh mesh;
  mesh.names = group_names(text);
  for (const ObjFile::Place& place : obj->vertices) {
    const bool shown = place.vertex != kMissing;
    mesh.positions.push_back(shown ? obj->pieces[place.piece].mesh.positions[place.vertex]
                                   : Vec3{});
    mesh.where.push_back({out.pieces.size() + place.piece, place.vertex});
  }
  for (Piece& piece : obj->pieces) out.pieces.push_back(std::move(piece));
  out.meshes.push_back(std::move(mesh));
  return {};
}

}  // namespace

Result<void> load_fdp_meshes(const XmlElement& mesh, const LoadMeshFile& load, FdpFile& out) {
  const std::string* file = mesh.attribute("file");
  if (file == nullptr || file->empty()) {
    return mesh.error(Code::syntax, "<mesh> needs an attribute file");
  }
  const std::string* path = mesh.attribute("path");
  const std::string name = (path == nullptr ? "" : *path) + *file;
  if (!stays_in_folder(name)) {
    return mesh.error(Code::invalid_argument, "the mesh " + in_quotes(name) +
                                                  " is not in the folder of the .fdp file; put it "
                                                  "there and name it without a path");
  }
  const std::string lower = fap::detail::lower_case(name);
  const bool wrl = lower.ends_with(".wrl");
  if (!wrl && !lower.ends_with(".obj")) {
    return mesh.error(Code::unsupported,
                      "the mesh " + in_quotes(name) + " is neither .wrl (VRML97) nor .obj");
  }
  const Result<std::string> text = load(name);
  if (!text) return text.error().in_file(name);
  const Result<void> done = wrl ? add_wrl(*file, *text, out) : add_obj(*text, out);
  return done ? done : Result<void>(done.error().in_file(name));
}

}  // namespace animeme::head::detail
