/// @file
/// Atomic file output: a file is written completely or not at all.
///
/// Data is written to a temporary file in the same folder with an unpredictable name (".animeme-"
/// with twelve random letters and ".part", created with O_EXCL), flushed to disk (fsync) and
/// renamed at the end. It has the mode of the file that it replaces. Symbolic links are followed:
/// the target is replaced, the link stays. Unpublished files are removed by the destructor, when
/// the program exits, and by clean_up_on_signals().
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// A file that is written piecewise. "-" is standard output; like devices and pipes (/dev/null,
/// /dev/stdout), it is written directly.
class OutputFile {
 public:
  explicit OutputFile(std::string path);    ///< opens nothing yet
  OutputFile(OutputFile&& other) noexcept;  ///< movable
  OutputFile(const OutputFile&) = delete;
  ~OutputFile();

  /// Appends. Errors, with the path: io (disk full, no such folder, no permission).
  Result<void> write(std::span<const std::uint8_t> bytes);
  Result<void> write(std::string_view text);  ///< the same for text
  /// The temporary name, for libraries that write to a file name; the file exists and is empty.
  /// Errors: as write(); io if the output is not a regular file, including "-".
  Result<std::string> place();
  /// Completes the file and renames it. Errors: as write().
  Result<void> publish();

 private:
  Result<void> open();
  void forget();  // closes, and removes what waits

  std::string path_;       // as it was given
  std::string target_;     // what the links lead to
  std::string temporary_;  // empty: there is none
  std::size_t note_ = 0;   // in the list of unfinished files
  int descriptor_ = -1;
};

/// Checks before long work that a file of this name can be written: creates and removes a temporary
/// file next to it. Devices and standard output ("-") are tested with an empty write, pipes only
/// for permission. Errors: those of OutputFile.
Result<void> try_output(const std::string& path);
/// Flushes standard output and checks that everything was written. Errors: io.
Result<void> flush_standard_output();

/// Writes a file whole or not at all; "-" is standard output. Errors: those of OutputFile.
Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes);
Result<void> write_file(const std::string& path, std::string_view text);  ///< the same for text

/// A file to be written.
struct OutputText {
  std::string path;       ///< path of the file
  std::string_view text;  ///< borrowed
};
/// Writes several files, all of them or none. Errors: io.
Result<void> write_files(std::span<const OutputText> files);

}  // namespace animeme::tools
