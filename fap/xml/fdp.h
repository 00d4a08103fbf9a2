/// @file
/// Xface's .fdp files: a face that MPEG-4 FAPs move, as XML beside its meshes.
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
/// FAPs that move the region by raised cosines. Its README says what Xface makes of it, and how
/// near write_fdp() comes to our own rig.
#pragma once

#include <functional>

#include "fap/head/own_head.h"
#include "fap/head/rig.h"

namespace animeme::head {

/// Gives the content of a file beside the .fdp that it or its meshes name ("alice.wrl",
/// "alice.tga"), or says why it cannot.
using LoadMeshFile = std::function<Result<std::string>(const std::string& name)>;

/// Reads a head as Xface would show it. Meshes are those of the entity "Rest", VRML97 or OBJ.
///
/// Source::targets are the influences of the file: raised cosines, several on one vertex add up,
/// the first eight on a vertex count. FAPU are those of the file, points the `fdp` elements whose
/// names are feature points (the first of each), eyes the pivots of the bindings LeftEye and
/// RightEye (Xface notes them with opposite signs; either way is understood). Lower teeth, tongue
/// and eyes that are bound or named as such are left to our rig, which turns them. A texture (TGA)
/// gives the vertices the colours at their places on it, in place of those of the mesh; one that
/// is missing, damaged or of another format, that lies outside of the folder or lacks coordinates
/// is left out, and Source::notes says why, also of textures that Xface itself would not show.
///
/// Not used: other entities (visemes and expressions as whole meshes: FAP 1 and 2 are shown by the
/// shapes of shapes.h), textures of .obj, translation and rotation (those of the camera of Xface),
/// and influences of FAPs that move no vertex (turns of the head, pupils, FAP 1 and 2).
/// Source::notes says so.
///
/// Errors, with the line: syntax (no XML, or no `xfdp`; a number that is none), out_of_range (a
/// vertex that the mesh does not have, a FAP beyond 68, limits of size), not_found (no entity Rest;
/// no `fdp` that fits a mesh), invalid_argument (a mesh outside the folder), unsupported (entities
/// of XML, a mesh of another format), and those of the mesh readers, with the file. Meshes that
/// `load` does not give are not_found with the names of all of them, or its other errors.
Result<Source> read_fdp(std::string_view text, const LoadMeshFile& load);

/// How write_fdp() writes.
struct FdpOptions {
  std::string name = "head";  ///< of the files; letters, digits, '-' and '_'
  /// Units of the file for one centimetre; Xface's own heads count millimetres.
  double scale = 10;
  /// Most regions that one FAP gets on a mesh, 1..100. With 1 each FAP has one region, easily
  /// edited in XfaceEd; more come nearer to our rig and leave fewer creases.
  int regions = 64;
};

/// A texture of a face.
struct FdpTexture {
  std::string name;     ///< of the file, as NAME_skin.tga
  std::string content;  ///< its bytes
};

/// The files of a face, as text.
struct FdpFiles {
  std::string fdp;                   ///< NAME.fdp
  std::string wrl;                   ///< NAME.wrl, named in it
  std::vector<FdpTexture> textures;  ///< named in the .wrl; one for each part that has colours
};

/// Writes a head for Xface. One VRML97 file, a submesh for each part that is not empty; an entity
/// "Rest"; its colours at the vertices and, as Xface shows no others, by textures (uncompressed TGA
/// of 128 x 128: not a picture of the face, but of its colours, on which each vertex has the place
/// of its own one); bindings of hair, eyes, teeth and tongue; all feature points, and regions for
/// each FAP, fitted to what the rig does with it. A feature point moves exactly as its FAPs say
/// (twice a weight of 0.5); no vertex has more than eight influences, the weakest are left out.
/// What Xface cannot show is left out: pupils, the rolled tongue, moves across the direction of a
/// FAP.
///
/// Errors: invalid_argument (options out of range; a head whose skin has no feature point, or no
/// FAPU), out_of_range (a part with more than 65536 vertices).
Result<FdpFiles> write_fdp(const Head& head, const Rig& rig, const FdpOptions& options = {});

}  // namespace animeme::head
