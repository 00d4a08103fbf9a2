/// @file
/// Folders and files of the user alone, such as a cache: nobody else writes there, and no link is
/// followed, so that nobody else chooses what is read or replaced.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// Makes a folder, and those that it lies in, with mode 0700. A folder that exists has to belong to
/// this user, and gets that mode. Errors, with the path: io (a link, not a folder, of somebody
/// else, cannot be made).
Result<void> make_private_folder(const std::string& path);

/// Reads a file of such a folder. Errors, with the path: not_found; io (a link, not an ordinary
/// file, of somebody else, writable by others; the same for its folder), out_of_range (more than
/// `most` bytes).
Result<std::vector<std::uint8_t>> read_private_file(const std::string& path, std::uint64_t most);

/// Writes a file of such a folder, whole or not at all, with mode 0600; a link of that name is
/// replaced, not followed. Makes the folder. Errors: those of make_private_folder(); io.
Result<void> write_private_file(const std::string& path, std::string_view bytes);

}  // namespace animeme::tools
