// An .fdp file as plain values, its meshes loaded.
#pragma once

#include <set>

#include "fap/head/detail/scene.h"
#include "fap/head/obj.h"
#include "fap/xml/detail/document.h"
#include "fap/xml/detail/tga.h"
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

/// Adds the meshes of the files that the <mesh> elements of an entity name, with their textures.
Result<void> load_fdp_meshes(const XmlElement& entity, const LoadMeshFile& load, FdpFile& out);

/// Gives colours to pieces of a file that have textures. One picture is kept at a time.
class FdpTextures {
 public:
  /// `folder`: of the file that names them, within that of the .fdp; empty or with a '/' at its
  /// end.
  FdpTextures(const LoadMeshFile& load, std::string folder, std::vector<std::string>& notes)
      : load_(load), folder_(std::move(folder)), notes_(notes) {}

  /// Colours of the vertices that the texture of a piece reaches; a note, if there is none.
  void paint(const std::string& mesh, const ScenePicture& from, Piece& piece);

 private:
  const TgaPicture* picture(const std::string& url);

  const LoadMeshFile& load_;
  std::string folder_;
  std::vector<std::string>& notes_;
  std::set<std::string> told_;  // notes that there are
  std::string url_;             // of picture_
  std::optional<TgaPicture> picture_;
  std::size_t texels_ = 0;  // of all that were read
};

/// True for a file beside the .fdp or below: nothing else may be asked for by a file from
/// elsewhere.
bool stays_in_folder(std::string_view name);

}  // namespace animeme::head::detail
