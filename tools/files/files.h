/// @file
/// Files as the tools read and write them: whole, by path, with "-" for the standard streams.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// All bytes of a file, or of standard input for "-". Errors: not_found, io.
Result<std::vector<std::uint8_t>> read_file(const std::string& path);
Result<std::string> read_text_file(const std::string& path);  ///< likewise, as text

/// Writes a file whole or not at all (temporary file beside it, then rename); "-" is standard
/// output. Errors: io.
Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes);
Result<void> write_file(const std::string& path, std::string_view text);  ///< likewise, of a text

/// A file to be written; the text is borrowed.
struct OutputText {
  std::string path;       ///< where to
  std::string_view text;  ///< borrowed
};
/// Writes several files: all of them whole, or none. Errors: io.
Result<void> write_files(std::span<const OutputText> files);

/// Extension in lower case with its dot, ".mp4"; "-" gives "".
std::string extension_of(const std::string& path);

/// "standard output" for "-", else the path; for messages.
std::string name_of_output(const std::string& path);

}  // namespace animeme::tools
