/// @file
/// Reading whole files by path, with "-" for standard input.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/files/output_file.h"

namespace animeme::tools {

/// Maximum size of a text input such as a script, a transcript or settings. Enough for days of
/// speech.
inline constexpr std::uint64_t kMostWritten = std::uint64_t(64) << 20;

/// Reads all bytes of a file, or of standard input for "-". Errors, with the path: not_found; io,
/// also for folders and devices; out_of_range (more than `most` bytes, default 1 GB; checked by its
/// size before reading); syntax (begins with 4 kB of zeros, such as a sparse file).
Result<std::vector<std::uint8_t>> read_file(const std::string& path,
                                            std::uint64_t most = std::uint64_t(1) << 30);
/// The same for text; a zero byte near the beginning is also an error (syntax), unless it is
/// UTF-16.
Result<std::string> read_text_file(const std::string& path, std::uint64_t most = std::uint64_t(1)
                                                                                 << 30);

/// Extension in lower case with its dot, ".mp4"; "-" gives "".
std::string extension_of(const std::string& path);

/// "standard output" for "-", else the path; for messages.
std::string name_of_output(const std::string& path);

}  // namespace animeme::tools
