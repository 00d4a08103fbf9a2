// The container of a .glb: a header and chunks.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "fap/result.h"

namespace animeme::gltf {

struct Chunks {
  std::span<const std::uint8_t> json;
  std::optional<std::span<const std::uint8_t>> binary;
};

/// Bytes of a .glb from its header; nothing if this is none. `bytes`: the first 12 or more.
std::optional<std::size_t> glb_length(std::span<const std::uint8_t> bytes);

/// The parts of a .glb, or the text of a .gltf. Errors: syntax, truncated, unsupported.
Result<Chunks> chunks_of(std::span<const std::uint8_t> bytes);

/// True for what begins as JSON of an object, beyond a byte order mark and white space.
bool looks_like_json(std::span<const std::uint8_t> bytes);

}  // namespace animeme::gltf
