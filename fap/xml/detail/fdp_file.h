// An .fdp file as plain values, its meshes loaded.
#pragma once

#include "fap/head/obj.h"
#include "fap/xml/detail/document.h"
#include "fap/xml/detail/xface.h"
#include "fap/xml/fdp.h"

namespace animeme::head::detail {

/// What <fdp> and <bind> call a mesh: an IndexedFaceSet of a .wrl, or all of an .obj.
struct FdpMesh {
  std::vector<std::string> names;     ///< "alice.wrl_3", or the groups of an .obj
  std::string binding;                ///< "LeftEye"; empty: none
  std::vector<Vec3> positions;        ///< of the vertices as the file counts them
  std::vector<ObjFile::Place> where;  ///< of each in FdpFile::pieces; missing: not shown
  Transform place;                    ///< turns directions of the mesh to those of the head
};

struct FdpFile {
  std::vector<Piece> pieces;
  std::vector<FdpMesh> meshes;
  std::vector<XfaceItem> items;  ///< those whose mesh exists
  fap::Fapu fapu;                ///< 0 where the file has none
  std::array<std::optional<Vec3>, 2> eyes;
  std::vector<std::string> notes;
};

/// Errors: see read_fdp().
Result<FdpFile> load_fdp(std::string_view text, const LoadMeshFile& load);

/// Adds the meshes of the file that a <mesh> names.
Result<void> load_fdp_meshes(const XmlElement& mesh, const LoadMeshFile& load, FdpFile& out);

}  // namespace animeme::head::detail
