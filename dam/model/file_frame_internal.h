// The common frame of Animeme's binary files: magic, version, size, a body, a checksum; and how
// they are loaded. Internal.
//
//   8 bytes magic, u16 major and u16 minor version, u64 size of the body, body, u32 CRC-32 of
//   everything before; little endian
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::dam {

/// One kind of file. Another major version is refused; a newer minor version may append to the
/// body.
struct FileFormat {
  std::string_view magic;  ///< 8 characters
  std::uint16_t major = 1, minor = 0;
  std::string_view what;    ///< "model file", for messages
  std::string_view remedy;  ///< "train the model again": how to get another one
};

std::vector<std::uint8_t> frame_file(const FileFormat& format, std::span<const std::uint8_t> body);

struct FileBody {
  std::span<const std::uint8_t> bytes;  ///< of the file that was given
  bool newer_minor = false;             ///< something unknown may follow what is known
};
/// Errors: syntax (another kind of file, damaged), truncated, unsupported (another major version).
Result<FileBody> open_frame(const FileFormat& format, std::span<const std::uint8_t> file);

/// Code::syntax: the file is damaged, how, and what to do.
Error damaged_file(const FileFormat& format, const std::string& how);

/// Reads a file after checking its header: another kind of file, or one whose size differs from the
/// header, is not read. Errors, with the path: those of open_frame() about the header; not_found,
/// io.
Result<std::vector<std::uint8_t>> load_file(const FileFormat& format,
                                            const std::filesystem::path& path);

}  // namespace animeme::dam
