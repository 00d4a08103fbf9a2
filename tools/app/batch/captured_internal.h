/// @file
/// What a command prints, caught.
#pragma once

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>

namespace animeme::batch {

/// A descriptor of the program goes to a file as long as one lives; that of a worker that crashes
/// stays.
class Captured {
 public:
  /// `path`: of the file, which is made anew.
  Captured(int descriptor, const std::string& path)
      : descriptor_(descriptor),
        old_(::dup(descriptor)),
        file_(::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600)) {
    if (file_ >= 0) ::dup2(file_, descriptor_);
  }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  ~Captured() {
    if (old_ >= 0) ::dup2(old_, descriptor_);
    if (old_ >= 0) ::close(old_);
    if (file_ >= 0) ::close(file_);
  }
  /// What has been written so far.
  std::string text() const {
    std::fflush(stdout);
    std::cout.flush();
    std::cerr.flush();
    std::string all(std::size_t(std::max<off_t>(::lseek(file_, 0, SEEK_END), 0)), '\0');
    const ssize_t got = ::pread(file_, all.data(), all.size(), 0);
    all.resize(std::size_t(std::max<ssize_t>(got, 0)));
    return all;
  }

 private:
  int descriptor_, old_, file_;
};

}  // namespace animeme::batch
