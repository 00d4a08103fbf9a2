// What is compressed becomes plain: buffer views by meshopt (EXT_meshopt_compression,
// KHR_meshopt_compression), meshes by Draco (KHR_draco_mesh_compression). By the libraries
// meshoptimizer and draco (Debian packages libmeshoptimizer-dev, libdraco-dev), optional parts of
// the build (ANIMEME_WITH_MESHOPT, ANIMEME_WITH_DRACO); without them nothing is done here, and
// check_extensions() says why a file is not read.
#pragma once

#include "fap/result.h"
#include "tools/view/gltf/detail/file.h"

namespace animeme::gltf {

/// True if this build has the library.
bool can_unpack_meshopt();
bool can_unpack_draco();

/// Unpacks all views: afterwards each lies in a buffer of its own. Errors: syntax (damaged, sizes
/// that cannot be), truncated (a view beyond its buffer), out_of_range (more bytes than the limits
/// allow), unsupported (a mode or filter of a later version).
Result<void> unpack_meshopt(File& file);

/// Unpacks all primitives: afterwards their accessors lie in buffers of their own; indices have 32
/// bits. Errors: as above.
Result<void> unpack_draco(File& file);

}  // namespace animeme::gltf
