/// @file
/// Temporary folders.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "fap/result.h"

namespace animeme::tools {

/// A folder that the destructor removes with its content.
class ScratchFolder {
 public:
  /// Creates a folder in the system's temporary folder (TMPDIR). Errors: io.
  static Result<std::unique_ptr<ScratchFolder>> make();
  /// Takes ownership of an existing folder.
  explicit ScratchFolder(std::filesystem::path path) : path_(std::move(path)) {}
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  const std::filesystem::path& path() const { return path_; }  ///< removed by the destructor
  /// The path of a file in it.
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace animeme::tools
