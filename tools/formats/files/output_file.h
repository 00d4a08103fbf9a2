/// @file
/// The one way in which files are written: whole or not at all.
///
/// What is written lies in the folder of the wanted file under a name that nobody can foresee
/// (".animeme-" with twelve random letters and ".part", made with O_EXCL), is brought to the disk
/// (fsync), and takes the wanted name at the end. It has the mode of the file that it replaces. A
/// symbolic link is followed: the file that it leads to is replaced, the link stays. Whatever is
/// not published is removed when the object goes, when the program exits, and by
/// clean_up_on_signals().
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// A file that is written bit by bit. "-" is standard output, which gets everything at once, as do
/// devices and pipes (/dev/null, /dev/stdout).
class OutputFile {
 public:
  explicit OutputFile(std::string path);    ///< nothing is opened yet
  OutputFile(OutputFile&& other) noexcept;  ///< the other one no longer writes
  OutputFile(const OutputFile&) = delete;
  ~OutputFile();

  /// Appends. Errors, with the path: io (no room, no such folder, no right
  /// to write to it).
  Result<void> write(std::span<const std::uint8_t> bytes);
  Result<void> write(std::string_view text);  ///< likewise, of a text
  /// The file as it is called now, for those who write it by its name; it is there, and empty.
  /// Errors: as write(); io where it is no ordinary file, "-" included.
  Result<std::string> place();
  /// All is written: the file takes its name. Errors: as write().
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

/// Whether a file of this name could be written now, so that it is known before long work: makes
/// one beside it, of a few bytes, and takes it away. Devices and standard output, "-", are asked by
/// a write of nothing, pipes only for the right. Errors: those of OutputFile.
Result<void> try_output(const std::string& path);
/// Whether all that was printed arrived: standard output is flushed. Errors: io.
Result<void> flush_standard_output();

/// Writes a file whole or not at all; "-" is standard output. Errors: those of OutputFile.
Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes);
Result<void> write_file(const std::string& path, std::string_view text);  ///< likewise, of a text

/// A file to be written; the text is borrowed.
struct OutputText {
  std::string path;       ///< where to
  std::string_view text;  ///< borrowed
};
/// Writes several files: all of them whole, or none. Errors: io.
Result<void> write_files(std::span<const OutputText> files);

}  // namespace animeme::tools
