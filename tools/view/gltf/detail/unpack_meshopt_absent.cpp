// Stands in for unpack_meshopt.cpp where the library was not there at build time.
#include "tools/view/gltf/detail/unpack.h"

namespace animeme::gltf {

bool can_unpack_meshopt() { return false; }
Result<void> unpack_meshopt(File&) { return {}; }

}  // namespace animeme::gltf
