/// @file
/// One program at a time: for files that are read, added to and written again.
#pragma once

#include <string>

#include "fap/result.h"

namespace animeme::tools {

/// Keeps a file from other programs that ask, too, as long as it lives. The lock is the file
/// ".NAME.lock" beside it (flock(2)); it goes when the program ends, however it ends.
class FileLock {
 public:
  /// Error, with the path: io (somebody has it; there is no such folder, or it cannot be written
  /// to).
  static Result<FileLock> take(const std::string& path);
  FileLock(FileLock&& other) noexcept;  ///< the other one no longer holds it
  FileLock(const FileLock&) = delete;
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

 private:
  FileLock(std::string name, int descriptor);
  std::string name_;
  int descriptor_;
};

}  // namespace animeme::tools
