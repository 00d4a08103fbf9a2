/// @file
/// Xface's .fdp files: a face that FAPs move, as XML beside its meshes.
///
///     auto load = [&](const std::string& name) { return read_whole_file(folder / name); };
///     animeme::Result<animeme::head::Source> source = animeme::head::read_fdp(text, load);
///     animeme::head::Head head = *animeme::head::assemble(std::move(*source));  // own_head.h
///
///     animeme::head::FdpFiles files = *animeme::head::write_fdp(head, rig, {.name = "me"});
///     // files.fdp into me.fdp, files.wrl into me.wrl, files.textures by their names, all in one
///     // folder: ready for XfacePlayer
///
/// The file names meshes, FAPU, and for each feature point a vertex, a region around it and the
/// FAPs that move the region by raised cosines. fap/xml/README.md describes how Xface interprets
/// it, and how closely write_fdp() approximates the rig.
#pragma once

#include <functional>

#include "fap/head/own_head.h"
#include "fap/head/rig.h"

namespace animeme::head {

/// Returns the content of a file that the .fdp or its meshes name ("alice.wrl", "alice.tga"), or an
/// error.
using LoadMeshFile = std::function<Result<std::string>(const std::string& name)>;

/// Reads a head as Xface would show it. Meshes are those of the entity "Rest", VRML97 or OBJ.
///
/// Source::targets are the influences of the file: raised cosines, which add up on a vertex; the
/// first eight on a vertex count. FAPU are those of the file, points the `fdp` elements whose names
/// are feature points (the first of each), eyes the pivots of the bindings LeftEye and RightEye
/// (Xface writes them with opposite signs; both forms are understood). Lower teeth, tongue and eyes
/// that are bound or named as such are left to the rig, which turns them. A texture (TGA) replaces
/// the vertex colours by its colours at their texture coordinates; a texture that is missing,
/// damaged, of another format, outside the folder or without coordinates is ignored with a note,
/// and so are textures that Xface itself would not show.
///
/// Not used: other entities (visemes and expressions as whole meshes: FAP 1 and 2 are shown by the
/// shapes of shapes.h), textures of .obj, translation and rotation (those of the camera of Xface),
/// and influences of FAPs that move no vertex (head rotation, pupils, FAP 1 and 2). Source::notes
/// lists them.
///
/// Errors, with the line: syntax (not XML, or no `xfdp`; an invalid number), out_of_range (a vertex
/// that the mesh does not have, a FAP beyond 68, size limits), not_found (no entity Rest; no `fdp`
/// that matches a mesh), invalid_argument (a mesh outside the folder), unsupported (XML entities, a
/// mesh of another format), and those of the mesh readers, with the file. Meshes that `load` does
/// not find are not_found with the names of all of them; its other errors are passed on.
Result<Source> read_fdp(std::string_view text, const LoadMeshFile& load);

/// Options of write_fdp().
struct FdpOptions {
  std::string name = "head";  ///< of the files; letters, digits, '-' and '_'
  /// Units of the file per centimetre; Xface's own heads are in millimetres.
  double scale = 10;
  /// Largest number of regions per FAP and mesh, 1..100. With 1 each FAP has one region, easily
  /// edited in XfaceEd; more approximate the rig better and leave fewer creases.
  int regions = 64;
  /// Writes FdpFiles::keyframes, without which Xface shows no FAP 1 and 2. They take some 3 MB
  /// each; parts that stay in all of them are then in a mesh file of their own.
  bool keyframes = false;
};

/// A file beside that of the face.
struct FdpTexture {
  std::string name;     ///< file name, such as NAME_skin.tga
  std::string content;  ///< its bytes
};

/// The files of a face, as text.
struct FdpFiles {
  std::string fdp;                   ///< NAME.fdp
  std::string wrl;                   ///< NAME.wrl, named in it
  std::vector<FdpTexture> textures;  ///< named in the .wrl; one for each part that has colours
  /// If asked for: NAME_still.wrl and, as NAME_ALIAS.wrl, the visemes and expressions by which
  /// Xface shows FAP 1 and 2 (fap/head/face_models.md).
  std::vector<FdpTexture> keyframes;
};

/// Writes a head for Xface. One VRML97 file with a submesh for each part that is not empty; an
/// entity "Rest"; vertex colours, and textures, since Xface shows no vertex colours (uncompressed
/// TGA of 128 x 128: not an image of the face but a palette, on which each vertex has the
/// coordinate of its own colour); bindings of hair, eyes, teeth and tongue; all feature points, and
/// regions for each FAP, fitted to its effect in the rig. A feature point moves exactly as its FAPs
/// say (twice a weight of 0.5); no vertex has more than eight influences, the weakest are dropped.
/// What Xface cannot show is omitted: pupils, the rolled tongue, motion across the direction of a
/// FAP.
///
/// Errors: invalid_argument (options out of range; a head whose skin has no feature point, or no
/// FAPU), out_of_range (a part with more than 65536 vertices).
Result<FdpFiles> write_fdp(const Head& head, const Rig& rig, const FdpOptions& options = {});

}  // namespace animeme::head
