/// @file
/// Heads from glTF 2.0 files (.glb, .gltf, .vrm): Blender, Unity, Unreal, VRoid, Ready Player Me
/// and others write them.
///
///     Result<head::Source> source = gltf::read_head_file("anna.glb");
///     if (!source) return source.error();
///     head::Head head = *head::assemble(std::move(*source));
///
/// Reads all triangles of all scenes in the rest pose (skins in their bind pose); vertex colours
/// from COLOR_0 or the base colour and its texture, or all materials (ReadOptions::vertices); morph
/// targets with known names (shape_names.h); bones of head, neck, eyes and jaw. Lights, cameras and
/// animations are ignored.
///
/// Duplicate vertices at texture seams are welded if position, shapes and bones agree; so the lips
/// are not joined. Triangles in which the texture changes are subdivided until vertex colours
/// represent it (brows, lips and irises are often painted), up to ReadOptions::vertices.
///
/// Feature points are estimated from the shapes, for the camera, the units and the point overlay;
/// see detail/point_guess.h for the rules and the README for their accuracy.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fap/head/own_head.h"
#include "fap/head/point_list.h"
#include "fap/result.h"
#include "tools/view/gltf/shape_rules.h"

namespace animeme::gltf {

/// The set of shapes that moves the mouth if a file has several.
enum class MouthShapes : std::uint8_t {
  automatic,  ///< ARKit's if the jaw and six mouth shapes exist, else visemes
  arkit,
  visemes,
};

/// Loads a file referenced by a .gltf, by its decoded URI ("textures/face.png"). If it fails for a
/// buffer, read_head() fails; missing textures are dropped with a note.
using LoadFile = std::function<Result<std::vector<std::uint8_t>>(const std::string& uri)>;

/// Limits that protect against excessive memory use. Data counts each time it is used: a mesh shown
/// by ten nodes counts ten times. Within these limits a small file takes less than 300 MB.
struct ReadLimits {
  /// Of the file; also of each referenced file, and of all its buffers together.
  std::size_t bytes = 256'000'000;
  /// Of all images together, in their original size: eight of 4096 x 4096. Further ones are dropped
  /// with a note.
  std::size_t texels = 150'000'000;
  std::size_t vertices = 500'000;  ///< also a quarter of the triangles
  std::size_t moves = 4'000'000;   ///< displacements of vertices by shapes
};

/// Loads files in `folder` or below, following links. Errors: not_found (no such file); unsupported
/// (web addresses, and files outside of the folder, by path or through a link); io (not a regular
/// file); out_of_range (more than `most` bytes).
LoadFile files_of(std::string folder, std::size_t most = ReadLimits{}.bytes);

/// Options of read_head().
struct ReadOptions {
  LoadFile load = {};  ///< empty: referenced files cannot be read
  /// The set of shapes that moves the mouth if there are several.
  MouthShapes mouth = MouthShapes::automatic;
  /// What names mean that are not known, or mean something else (shape_rules.h). These shapes go
  /// before those of other names.
  ShapeRules rules = {};
  /// Triangles are subdivided to represent textures by vertex colours, up to this number of
  /// vertices. 0: no subdivision; the head keeps its materials and textures, if any
  /// (Source::materials).
  std::size_t vertices = 60000;
  ReadLimits limits = {};  ///< limits of the file
};

/// Reads a head. `bytes`: a .glb (also .vrm), or the text of a .gltf. Deterministic.
///
/// The result has pieces (a mesh of each node and part), shapes and targets, eyes, jaw_axis and
/// neck_pivot where there are bones of that name, estimated points if the shapes allow; +Y is up
/// and the face looks along +Z (`upright`; a head in another orientation is rotated if its shapes
/// reveal it). `centimetres` stays 0. `notes` reports what was dropped or guessed.
///
/// Errors: syntax (not glTF; an invalid index, length or enumeration), truncated (the file ends too
/// early), unsupported (glTF 1.0; Draco or meshopt compression and other required extensions: the
/// message says what to export instead), not_found (a buffer that `load` cannot provide; no
/// triangle; a rule for a name that no morph target has), out_of_range (more than
/// ReadOptions::limits, a million values in its JSON, or all memory). A head without known shapes
/// is not an error; the caller must then provide its feature points.
Result<head::Source> read_head(std::span<const std::uint8_t> bytes,
                               const ReadOptions& options = {});

/// A vertex of a piece of the head.
struct PieceVertex {
  std::size_t piece = 0;                  ///< index of Source::pieces
  std::uint32_t vertex = head::kMissing;  ///< kMissing: not shown
};

/// Maps the vertices of a mesh in the file to those of the head. Several may have been merged.
struct MeshVertices {
  std::string name;   ///< of its node and mesh, as Piece::name
  bool skin = false;  ///< at least partly skin
  /// In the order of the file: primitive by primitive those that have a triangle, as in Blender.
  std::vector<PieceVertex> vertices;
};

/// A head with the mapping of its vertices.
struct HeadFile {
  head::Source source;               ///< as from read_head()
  std::vector<MeshVertices> meshes;  ///< of nodes that are shown, in their order
  std::vector<std::string> unknown;  ///< names of morph targets that say nothing (shape_names.h)
};

/// read_head() with the vertex numbers of the file.
Result<HeadFile> read_head_and_vertices(std::span<const std::uint8_t> bytes,
                                        const ReadOptions& options = {});
/// The same from a path.
Result<HeadFile> read_head_and_vertices(const std::string& path, ReadOptions options = {});

/// Resolves a list of landmarks on such a head. Vertex numbers refer to the mesh whose name equals
/// `mesh` of the row or contains it as a word, else to the first skin mesh. Coordinates give the
/// nearest vertex.
/// Errors: not_found with the line.
Result<std::vector<head::PiecePoint>> points_on(const HeadFile& file,
                                                const std::vector<head::PointRow>& rows);

/// read_head() of a file, with files_of() its folder if `options.load` is empty, and its name as
/// that of the head. Errors: those of read_head(), io; with the path.
Result<head::Source> read_head_file(const std::string& path, ReadOptions options = {});

}  // namespace animeme::gltf
