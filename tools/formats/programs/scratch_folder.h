/// @file
/// A folder for temporary files.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "fap/result.h"

namespace animeme::tools {

/// A folder that is removed with its content at the end.
class ScratchFolder {
 public:
  /// A new one where the system keeps such (TMPDIR). Errors: io.
  static Result<std::unique_ptr<ScratchFolder>> make();
  /// Takes over a folder that exists.
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
