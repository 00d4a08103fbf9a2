/// @file
/// Heads as folders of OBJ files: one at rest, and one for each shape.
///
///     face/neutral.obj
///     face/jawOpen.obj
///     face/eyeBlink_L.obj.gz
///
///     Result<HeadFile> head = gltf::read_obj_folder("face");
///
/// ICT-FaceKit, FaceWarehouse, Wrap and most scans come like this. The name of a file is that of
/// its shape (shape_names.h), or has a rule (ReadOptions::rules). The file at rest is called
/// neutral (neutral.obj, generic_neutral_mesh.obj), else base, basis, rest, mean, template or
/// default.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

/// Reads such a folder, not those in it; other files are ignored. Each .obj may be packed by gzip
/// (.obj.gz). Of a file at rest everything counts that head::read_obj() reads; of the others the
/// positions of the vertices.
///
/// The result is as from read_head(); MeshVertices::vertices of its only mesh are those of the file
/// at rest, counted from 0. `notes` names the files that are not used.
///
/// Errors: not_found (no .obj, none at rest, or a rule for a name that is not there), syntax, io
/// and out_of_range as of reading, with the path; invalid_argument (a shape has another number of
/// vertices than the head at rest).
Result<HeadFile> read_obj_folder(const std::string& folder, ReadOptions options = {});

/// The text of an .obj or an .obj.gz. Errors: as of reading; syntax (damaged, or no text);
/// out_of_range (larger than `most` bytes, also when unpacked).
Result<std::string> read_obj_text(const std::string& path, std::size_t most = ReadLimits{}.bytes);

}  // namespace animeme::gltf
