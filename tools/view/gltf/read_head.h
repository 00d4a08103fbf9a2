/// @file
/// Heads from glTF 2.0 files (.glb, .gltf, .vrm): Blender, Unity, Unreal, VRoid, Ready Player Me
/// and others write them.
///
///     Result<head::Source> source = gltf::read_head_file("anna.glb");
///     if (!source) return source.error();
///     head::Head head = *head::assemble(std::move(*source));
///
/// What is read: all triangles of all scenes as they stand at rest (skins in their bind pose),
/// colours at the vertices, from COLOR_0 or the base colour and its texture, or all materials
/// (ReadOptions::vertices); morph targets whose names are known (shape_names.h); bones of head,
/// neck, eyes and jaw. Lights, cameras and animations are not.
///
/// Vertices that were doubled at seams of a texture are welded where place, shapes and bones agree;
/// so the lips stay apart. Triangles in which the texture changes are divided until the colours at
/// the vertices show it (brows, lips and irises are often painted), up to ReadOptions::vertices.
///
/// Feature points are estimates from the shapes, for the camera, the units and the overlay of
/// points; see detail/point_guess.h for each rule and the README for how far they are off.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fap/head/own_head.h"
#include "fap/head/point_list.h"
#include "fap/result.h"

namespace animeme::gltf {

/// Which shapes move the mouth if a file has several sets of them.
enum class MouthShapes : std::uint8_t {
  automatic,  ///< ARKit's if the jaw and six shapes of the mouth are there, else visemes
  arkit,
  visemes,
};

/// Gives the bytes of a file that a .gltf names, by its URI with %20 and the like resolved
/// ("textures/face.png"). An error of `load` for a buffer is one of read_head(); textures that it
/// does not give are left out with a note.
using LoadFile = std::function<Result<std::vector<std::uint8_t>>(const std::string& uri)>;

/// Limits of a file, against those that would take all memory. What is counted is what is used, as
/// often as it is used: a mesh that ten nodes show counts ten times. Within these, what a small
/// file claims takes less than 300 MB.
struct ReadLimits {
  /// Of the file; likewise of one file that it names, and of all its buffers together.
  std::size_t bytes = 256'000'000;
  /// Of all pictures together as they are in the file: eight of 4096 x 4096. Those beyond are left
  /// out with a note.
  std::size_t texels = 150'000'000;
  std::size_t vertices = 500'000;  ///< also a quarter of the triangles
  std::size_t moves = 4'000'000;   ///< of one vertex by one shape, where there is one
};

/// Loads files that lie in `folder` or below, links followed. Errors: not_found if there is no such
/// file; unsupported for addresses of the web and for what lies outside of the folder, by its path
/// or as a link leads; io for what is no ordinary file; out_of_range for more than `most` bytes.
LoadFile files_of(std::string folder, std::size_t most = ReadLimits{}.bytes);

/// What read_head() is told.
struct ReadOptions {
  LoadFile load = {};  ///< empty: only files without others beside them can be read
  /// Which shapes move the mouth if there are several sets.
  MouthShapes mouth = MouthShapes::automatic;
  /// Triangles are divided for the sake of their texture until there are as many vertices. 0: not,
  /// and the head keeps its materials and textures, if it has any (Source::coats).
  std::size_t vertices = 60000;
  ReadLimits limits = {};  ///< what a file may hold
};

/// Reads a head. `bytes`: a .glb (also .vrm), or the text of a .gltf. Deterministic.
///
/// The result has pieces (a mesh of each node and part), shapes and targets, eyes, jaw_axis and
/// neck_pivot where there are bones of that name, estimated points where shapes tell them; +Y is up
/// and the face looks along +Z (`upright`; a head that was modelled otherwise is turned if the
/// places of its shapes say so). `centimetres` stays 0. `notes` tells what was left out or guessed.
///
/// Errors: syntax (no glTF; an index, a length or an enumeration that cannot be), truncated (the
/// file ends too early), unsupported (glTF 1.0; Draco or meshopt compression and other required
/// extensions: the sentence says what to export instead), not_found (a buffer that `load` does not
/// give; no triangle), out_of_range (more than ReadOptions::limits, a million values in its JSON,
/// or all memory). A head without any shape that is known is no error: the caller has to know its
/// feature points.
Result<head::Source> read_head(std::span<const std::uint8_t> bytes,
                               const ReadOptions& options = {});

/// A vertex of a piece of the head.
struct PieceVertex {
  std::size_t piece = 0;                  ///< index of Source::pieces
  std::uint32_t vertex = head::kMissing;  ///< kMissing: it is not shown
};

/// Where the vertices of a mesh of the file went. Several may have become one.
struct MeshVertices {
  std::string name;   ///< of its node and mesh, as Piece::name
  bool skin = false;  ///< some of it is
  /// By their numbers in the file: of one primitive after the other those that have a triangle, as
  /// Blender shows them.
  std::vector<PieceVertex> vertices;
};

/// A head and where the vertices of the file went.
struct HeadFile {
  head::Source source;               ///< as from read_head()
  std::vector<MeshVertices> meshes;  ///< of nodes that are shown, in their order
};

/// read_head() with the numbers that vertices have in the file.
Result<HeadFile> read_head_and_vertices(std::span<const std::uint8_t> bytes,
                                        const ReadOptions& options = {});
/// Likewise, from a path.
Result<HeadFile> read_head_and_vertices(const std::string& path, ReadOptions options = {});

/// A list of landmarks on such a head. Vertices are counted in the mesh whose name has the word
/// `mesh` of the row, or is all of it; else in the first that is skin. Places: the nearest vertex.
/// Errors: not_found with the line.
Result<std::vector<head::PiecePoint>> points_on(const HeadFile& file,
                                                const std::vector<head::PointRow>& rows);

/// read_head() of a file, with files_of() its folder if `options.load` is empty, and its name as
/// that of the head. Errors: those of read_head(), io; with the path.
Result<head::Source> read_head_file(const std::string& path, ReadOptions options = {});

}  // namespace animeme::gltf
