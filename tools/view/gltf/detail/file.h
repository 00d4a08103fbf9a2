// A glTF file: its JSON and its buffers.
//
// tinygltf is not used: version 2.7 of Debian 12 reads up to eight bytes past a truncated .glb,
// takes images from offsets it does not check, and its recursive reader of `extras` overflows the
// stack for deeply nested ones. The JSON is read by tools/formats/common.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/view/gltf/detail/budget.h"
#include "tools/view/gltf/detail/json_access.h"
#include "tools/view/gltf/detail/uri.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

using Bytes = std::vector<std::uint8_t>;

struct File {
  Json root;
  std::vector<std::span<const std::uint8_t>> buffers;  ///< in `owned`, or in what was opened
  std::list<Bytes> owned;
  std::unique_ptr<Budget> budget;

  /// Entry `index` of a list of the root ("meshes"); null if there is none.
  const Json& entry(const char* key, std::size_t index) const {
    const std::span<const Json> all = gltf::list(root, key);
    return index < all.size() ? all[index] : member(root, "");
  }
  bool uses(std::string_view extension) const;
};

/// The bytes of a head: those that the header of a .glb counts, of another file all. What cannot be
/// glTF is not read beyond its first bytes. Errors: not_found, io, syntax, truncated, out_of_range
/// (more than `most`).
Result<Bytes> bytes_of(const std::string& path, std::size_t most);

/// What the JSON of a file says, of whatever extensions and without any buffer. Errors: syntax,
/// unsupported (another version), out_of_range (more values than are read).
Result<File> open_json(std::span<const std::uint8_t> json, const ReadLimits& limits);

/// `bytes` have to outlive the result. Errors: see read_head().
Result<File> open_file(std::span<const std::uint8_t> bytes, const LoadFile& load,
                       const ReadLimits& limits);

/// The bytes of a buffer view, or an error that names it.
Result<std::span<const std::uint8_t>> view_of(const File& file, std::size_t view);

}  // namespace animeme::gltf
