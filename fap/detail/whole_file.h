// Files that are read as a whole: by blocks, up to a limit, with a check of the first block. A
// name may lead to a device that never ends, and a small file on disk may claim to be a huge one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <istream>
#include <span>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::fap::detail {

/// What a file may be.
struct WholeLimits {
  std::uint64_t bytes = std::uint64_t(1) << 30;  ///< more are out_of_range
  bool text = false;  ///< a zero byte in the first block is a syntax error, unless it is UTF-16
  /// Checks the first block (4 kB, or the whole file) before the rest is read; may be empty.
  std::function<Result<void>(std::span<const std::uint8_t>)> look = {};
};

/// Reads a file. Errors, without the path: not_found, io (a folder, a device, cannot be read),
/// out_of_range (larger than the limit, by its size before anything is read), syntax (4 kB of zeros
/// only, as from a hole in a file; not a text), those of `look`.
Result<std::vector<std::uint8_t>> read_whole(const std::filesystem::path& path,
                                             const WholeLimits& limits = {});
Result<std::string> read_whole_text(const std::filesystem::path& path, WholeLimits limits = {});

/// The same from a stream that is open already, such as standard input.
Result<std::vector<std::uint8_t>> read_whole(std::istream& in, const WholeLimits& limits = {});
Result<std::string> read_whole_text(std::istream& in, WholeLimits limits = {});

}  // namespace animeme::fap::detail
