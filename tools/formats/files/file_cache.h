/// @file
/// A cache of values derived from files.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <list>
#include <mutex>
#include <string>
#include <system_error>

#include "fap/result.h"

namespace animeme::tools {

/// Keeps the last few values read from files. A file whose time or size has changed is read again;
/// files that it refers to are not checked. Thread safe.
template <class T>
class FileCache {
 public:
  /// The result of `read` for the file `path`, cached by path and settings `how`. A path that is
  /// not a file names something constant. Errors: those of `read`, not cached.
  template <class Read>
  Result<T> get(const std::string& path, const std::string& how, Read read) {
    const std::lock_guard lock(mutex_);
    std::error_code unknown;
    const auto time = std::filesystem::last_write_time(path, unknown).time_since_epoch().count();
    const std::uintmax_t size = std::filesystem::file_size(path, unknown);
    for (auto at = kept_.begin(); at != kept_.end(); ++at) {
      if (at->path != path || at->how != how || at->time != time || at->size != size) continue;
      kept_.splice(kept_.begin(), kept_, at);
      return kept_.front().value;
    }
    Result<T> value = read();
    if (!value) return value;
    kept_.push_front({path, how, time, size, *value});
    if (kept_.size() > kMost) kept_.pop_back();
    return value;
  }

 private:
  static constexpr std::size_t kMost = 4;
  struct Kept {
    std::string path, how;
    std::filesystem::file_time_type::rep time;
    std::uintmax_t size;
    T value;
  };
  std::mutex mutex_;
  std::list<Kept> kept_;
};

}  // namespace animeme::tools
