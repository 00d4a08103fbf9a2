/// @file
/// Files as the tools read them: whole, by path, with "-" for standard input.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/files/output_file.h"

namespace animeme::tools {

/// Most bytes of a text that a person or another program wrote down: a script, a transcript,
/// settings. Days of speech fit in.
inline constexpr std::uint64_t kMostWritten = std::uint64_t(64) << 20;

/// All bytes of a file, or of standard input for "-". Errors, with the path: not_found; io, also
/// for folders and devices; out_of_range (more than `most` bytes, 1 GB: known from its size before
/// anything is read); syntax (4 kB of zeros at its beginning: a hole, or no file at all).
Result<std::vector<std::uint8_t>> read_file(const std::string& path,
                                            std::uint64_t most = std::uint64_t(1) << 30);
/// Likewise, as text; a zero byte at its beginning is an error, too (syntax), unless it is UTF-16.
Result<std::string> read_text_file(const std::string& path, std::uint64_t most = std::uint64_t(1)
                                                                                 << 30);

/// Extension in lower case with its dot, ".mp4"; "-" gives "".
std::string extension_of(const std::string& path);

/// "standard output" for "-", else the path; for messages.
std::string name_of_output(const std::string& path);

}  // namespace animeme::tools
