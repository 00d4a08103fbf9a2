// Resolves the URIs of a file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

/// True for those that hold the bytes themselves.
bool is_data_uri(std::string_view uri);

/// What an URI stands for: the bytes of a data URI, or what `load` gives. Errors: syntax (no
/// base64), not_found (no `load`), those of `load`.
Result<std::vector<std::uint8_t>> resolve(std::string_view uri, const LoadFile& load);

}  // namespace animeme::gltf
