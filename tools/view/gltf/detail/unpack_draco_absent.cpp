// Stands in for unpack_draco.cpp where the library was not there at build time.
#include "tools/view/gltf/detail/unpack.h"

namespace animeme::gltf {

bool can_unpack_draco() { return false; }
Result<void> unpack_draco(File&) { return {}; }

}  // namespace animeme::gltf
