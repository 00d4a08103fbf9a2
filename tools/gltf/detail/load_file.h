// Files that a head is made of.
#pragma once

#include <string>

#include "tools/gltf/detail/file.h"
#include "tools/gltf/read_head.h"

namespace animeme::gltf {

/// The whole of a file. Errors: not_found, io.
Result<Bytes> bytes_of(const std::string& path);

}  // namespace animeme::gltf
