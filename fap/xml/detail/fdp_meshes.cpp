#include <algorithm>

#include "fap/detail/text_scanner.h"
#include "fap/head/detail/scene.h"
#include "fap/xml/detail/fdp_file.h"

namespace animeme::head::detail {
namespace {

using fap::detail::in_quotes;

// Xface calls a mesh by the DEF name of its geometry, else FILE_0, FILE_1 ... of those without one.
Result<void> add_wrl(const std::string& file, std::string_view text, FdpTextures textures,
                     FdpFile& out) {
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
    if (shown) textures.paint(mesh.names.front(), scene_piece.picture, piece);
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

// One <mesh>. `missing` gets the name of its file if there is none, with the path where `load`
// looked for it, if it says so.
Result<void> add_mesh(const XmlElement& mesh, const LoadMeshFile& load, FdpFile& out,
                      std::vector<std::string>& missing) {
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
  if (!text && text.error().code == Code::not_found) {
    const std::string& found = text.error().where.file;
    const std::string& place = found.empty() ? name : found;
    if (std::find(missing.begin(), missing.end(), place) == missing.end()) missing.push_back(place);
    return {};
  }
  if (!text) return text.error().in_file(name);
  const std::string folder = name.substr(0, name.find_last_of("/\\") + 1);
  const Result<void> done =
      wrl ? add_wrl(*file, *text, {load, folder, out.notes}, out) : add_obj(*text, out);
  return done ? done : Result<void>(done.error().in_file(name));
}

Error missing_meshes(const XmlElement& entity, const std::vector<std::string>& places) {
  std::string list;
  for (const std::string& place : places) list += (list.empty() ? "\"" : ", \"") + place + "\"";
  return entity.error(Code::not_found,
                      "the meshes of the .fdp are missing: there is no mesh file " + list +
                          "; put the .wrl or .obj files that belong to it there "
                          "(a .dat file is a memory dump of "
                          "meshes that only Xface reads)");
}

}  // namespace

Result<void> load_fdp_meshes(const XmlElement& entity, const LoadMeshFile& load, FdpFile& out) {
  std::vector<std::string> missing;
  for (const XmlElement& mesh : entity.children) {
    if (mesh.name != "mesh") continue;
    if (auto done = add_mesh(mesh, load, out, missing); !done) return done;
  }
  if (missing.empty()) return {};
  return missing_meshes(entity, missing);
}

}  // namespace animeme::head::detail
