/// @file
/// Files as the tools read and write them: whole, by path, with "-" for the standard streams.
#pragma once

#include <cstdint>
#include <fstream>
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

/// A file that is written bit by bit: it lies beside its place until it is published, and is
/// removed if it never is. "-" is standard output, which gets everything at once, as do devices and
/// pipes.
class OutputFile {
 public:
  explicit OutputFile(std::string path);    ///< nothing is opened yet
  OutputFile(OutputFile&& other) noexcept;  ///< the other one no longer writes
  OutputFile(const OutputFile&) = delete;
  ~OutputFile();

  /// Appends. Errors: io, not_found (no such folder).
  Result<void> write(std::span<const std::uint8_t> bytes);
  Result<void> write(std::string_view text);  ///< likewise, of a text
  /// All is written: the file takes its place. Errors: io.
  Result<void> publish();

 private:
  Result<void> open();

  std::string path_;
  std::string target_;
  bool special_ = false;
  bool waiting_ = false;
  std::ofstream out_;
};

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
