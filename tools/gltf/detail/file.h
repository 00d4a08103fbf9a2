// The container: JSON and buffers of a .glb or .gltf.
//
// tinygltf is not used: version 2.7 of Debian 12 reads up to eight bytes past a truncated .glb,
// takes images from offsets it does not check, and its recursive reader of `extras` overflows the
// stack for deeply nested ones. The JSON is read by nlohmann_json, textures by stb_image.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/gltf/detail/json_access.h"
#include "tools/gltf/read_head.h"

namespace animeme::gltf {

using Bytes = std::vector<std::uint8_t>;

struct File {
  Json root;
  std::vector<Bytes> buffers;

  /// Entry `index` of a list of the root ("meshes"); null if there is none.
  const Json& entry(const char* key, std::size_t index) const {
    const std::vector<Json>& all = list(root, key);
    return index < all.size() ? all[index] : member(root, "");
  }
  bool uses(std::string_view extension) const;
};

/// The whole of a file. Errors: not_found, io.
Result<Bytes> bytes_of(const std::string& path);

/// Errors: see read_head().
Result<File> open_file(std::span<const std::uint8_t> bytes, const LoadFile& load);

/// The bytes of a buffer view, or an error that names it.
Result<std::span<const std::uint8_t>> view_of(const File& file, std::size_t view);

/// What an URI stands for: the bytes of a data URI, or what `load` gives.
Result<Bytes> resolve(const std::string& uri, const LoadFile& load);

}  // namespace animeme::gltf
