// The binary form of glTF: a header, the JSON and one buffer.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "fap/result.h"

namespace animeme::gltf {

/// The file; `root` gets its buffer from `binary`. Error: out_of_range (larger than 4 GB).
Result<std::vector<std::uint8_t>> glb_file(nlohmann::json root, std::vector<std::uint8_t> binary);

}  // namespace animeme::gltf
