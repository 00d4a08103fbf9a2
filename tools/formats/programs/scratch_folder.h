/// @file
/// Temporary folders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "fap/result.h"

namespace animeme::tools {

/// A folder that the destructor removes with its content. It may hold the text and the voice of
/// users, so signals remove it, too (clean_up_on_signals() of unfinished.h).
class ScratchFolder {
 public:
  /// Creates a folder in the system's temporary folder (TMPDIR), and first removes those that this
  /// user's processes left there more than a day ago, when they were killed. Errors: io.
  static Result<std::unique_ptr<ScratchFolder>> make();
  /// Takes ownership of an existing folder.
  explicit ScratchFolder(std::filesystem::path path);
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  const std::filesystem::path& path() const { return path_; }  ///< removed by the destructor
  /// The path of a file in it.
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
  std::size_t note_ = 0;  // of note_unfinished()
};

}  // namespace animeme::tools
