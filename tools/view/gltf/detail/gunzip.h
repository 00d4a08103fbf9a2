// Files packed by gzip.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "fap/result.h"

namespace animeme::gltf {

/// Whether bytes begin as gzip's do.
bool is_gzip(std::span<const std::uint8_t> bytes);

/// Unpacks them. Errors: syntax (damaged), truncated, out_of_range (more than `most` bytes).
Result<std::string> gunzip(std::span<const std::uint8_t> bytes, std::size_t most);

}  // namespace animeme::gltf
