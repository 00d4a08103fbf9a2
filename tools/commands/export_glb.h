/// @file
/// `animeme export` to glTF: a head that plays the clip.
#pragma once

#include <string>

#include "fap/frame.h"
#include "fap/result.h"
#include "tools/studio/head_file.h"

namespace animeme::tools {

/// What the user asks of `export` to .glb.
struct GlbExport {
  studio::HeadChoice head;       ///< whose head
  std::string morphs = "arkit";  ///< or "fap"
  std::string audio;             ///< name to mention; may be empty
  bool normals = false;          ///< write normals, too
};

/// Writes a .glb with progress and says so. Errors: those of gltf::make_glb(); io.
Result<void> export_glb(const std::string& path, const fap::Sequence& filled,
                        const GlbExport& options);

}  // namespace animeme::tools
