/// @file
/// File locks, for files that are read, extended and rewritten.
#pragma once

#include <string>

#include "fap/result.h"

namespace animeme::tools {

/// Holds an advisory lock on a file during its lifetime. The lock is the file ".NAME.lock" next to
/// it (flock(2)); it is released when the program ends in any way.
class FileLock {
 public:
  /// Errors, with the path: io (already locked; no such folder, or not writable).
  static Result<FileLock> take(const std::string& path);
  FileLock(FileLock&& other) noexcept;  ///< transfers the lock
  FileLock(const FileLock&) = delete;
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

 private:
  FileLock(std::string name, int descriptor);
  std::string name_;
  int descriptor_;
};

}  // namespace animeme::tools
