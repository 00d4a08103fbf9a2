#include "fap/head/wrl.h"

#include "fap/detail/number_text.h"
#include "fap/head/detail/scene.h"
#include "fap/head/srgb.h"

namespace animeme::head {
namespace {

using fap::detail::append_shortest;
using fap::detail::append_significant;

std::string word(std::string_view name) {
  std::string text;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-' ||
                       (c >= '0' && c <= '9' && !text.empty());
    text += plain ? c : '_';
  }
  return text;
}

void append(std::string& text, Vec3 v) {
  append_shortest(text, v.x);
  text += ' ';
  append_shortest(text, v.y);
  text += ' ';
  append_shortest(text, v.z);
}

Vec3 mean(std::span<const Vec3> colours) {
  Vec3 sum;
  for (const Vec3& c : colours) sum += c;
  return colours.empty() ? sum : sum * (1 / float(colours.size()));
}

void append_colour(std::string& text, Vec3 linear) {
  const Vec3 c = srgb_of_linear(linear);
  for (const float x : {c.x, c.y, c.z}) {
    append_significant(text, std::round(x * 1000) / 1000, 4);
    text += ' ';
  }
}

// Corners in threes, each followed by a comma, as plain scanners want it.
void append_triangles(std::string& text, std::string_view field,
                      const std::vector<Triangle>& triangles) {
  text += "    " + std::string(field) + " [\n";
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (i > 0) text += ",\n";
    for (const std::uint32_t v : triangles[i]) text += std::to_string(v) + ", ";
    text += "-1";
  }
  text += " ]\n";
}

void append_places(std::string& text, std::span<const TexturePlace> places) {
  text += "    texCoord TextureCoordinate { point [\n";
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i > 0) text += ",\n";
    append_significant(text, places[i].u, 5);
    text += ' ';
    append_significant(text, places[i].v, 5);
  }
  text += " ] }\n";
}

void append_shape(std::string& text, const Piece& piece, const PieceTexture& texture) {
  const Mesh& mesh = piece.mesh;
  if (!piece.name.empty()) text += "DEF " + word(piece.name) + " ";
  text += "Shape {\n";
  if (!mesh.colours.empty()) {
    text += "  appearance Appearance { material ";
    if (!piece.material.empty()) text += "DEF " + word(piece.material) + " ";
    text += "Material { diffuseColor ";
    append_colour(text, mean(mesh.colours));
    text += "}";
    if (!texture.file.empty()) {
      text += "\n    texture ImageTexture { url \"" + texture.file + "\" }";
    }
    text += " }\n";
  }
  text += "  geometry IndexedFaceSet {\n    coord Coordinate { point [\n";
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (i > 0) text += ",\n";
    append(text, mesh.positions[i]);
  }
  text += " ] }\n";
  if (!mesh.colours.empty()) {
    text += "    color Color { color [\n";
    for (const Vec3& c : mesh.colours) {
      append_colour(text, c);
      text += ",\n";
    }
    text += " ] }\n";
  }
  if (!texture.file.empty()) append_places(text, texture.places);
  append_triangles(text, "coordIndex", mesh.triangles);
  // The same again: Xface requires a texture index for each corner.
  if (!texture.file.empty()) append_triangles(text, "texCoordIndex", mesh.triangles);
  text += "    creaseAngle 3.14\n  }\n}\n";
}

}  // namespace

Result<std::vector<Piece>> read_wrl(std::string_view text, std::vector<std::string>* notes) {
  const auto scene = detail::wrl_scene(text, notes);
  if (!scene) return scene.error();
  auto flat = detail::scene_pieces(*scene);
  if (!flat) return flat.error();
  std::vector<Piece> pieces;
  for (detail::ScenePiece& piece : *flat) {
    if (!piece.piece.mesh.triangles.empty()) pieces.push_back(std::move(piece.piece));
  }
  if (pieces.empty()) {
    return make_error(Code::not_found, "no Shape with an IndexedFaceSet is in this VRML file");
  }
  return pieces;
}

std::string write_wrl(std::span<const Piece> pieces, std::span<const PieceTexture> textures) {
  std::string text = "#VRML V2.0 utf8\n";
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    append_shape(text, pieces[i], i < textures.size() ? textures[i] : PieceTexture{});
  }
  return text;
}

}  // namespace animeme::head
