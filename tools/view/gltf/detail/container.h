// The container of a .glb: a header and chunks.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::gltf {

struct Chunks {
  std::span<const std::uint8_t> json;
  std::optional<std::span<const std::uint8_t>> binary;
  std::span<const std::uint8_t> others;  ///< chunks behind these two, with their headers
};

/// Bytes of a .glb from its header; nothing if this is none. `bytes`: the first 12 or more.
std::optional<std::size_t> glb_length(std::span<const std::uint8_t> bytes);

/// The parts of a .glb, or the text of a .gltf. Errors: syntax, truncated, unsupported.
Result<Chunks> chunks_of(std::span<const std::uint8_t> bytes);

/// A .glb of a text, which is filled up with spaces, a binary part of `binary` bytes, whose length
/// is a multiple of 4, and `others` more: all that comes before the bytes of the binary part.
/// Error: out_of_range (larger than 4 GB).
Result<std::vector<std::uint8_t>> glb_front(std::string_view json, std::uint64_t binary,
                                            std::uint64_t others = 0);

/// True for what begins as JSON of an object, beyond a byte order mark and white space.
bool looks_like_json(std::span<const std::uint8_t> bytes);

}  // namespace animeme::gltf
