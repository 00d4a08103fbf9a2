#include "tools/formats/files/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace animeme::tools {

namespace {

// The previous owner may have removed the file that was just locked.
bool still_there(const std::string& name, int descriptor) {
  struct stat by_name = {}, locked = {};
  return ::lstat(name.c_str(), &by_name) == 0 && ::fstat(descriptor, &locked) == 0 &&
         by_name.st_ino == locked.st_ino && by_name.st_dev == locked.st_dev;
}

}  // namespace

FileLock::FileLock(std::string name, int descriptor)
    : name_(std::move(name)), descriptor_(descriptor) {}

FileLock::FileLock(FileLock&& other) noexcept
    : name_(std::move(other.name_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  ::unlink(name_.c_str());  // first, so that no process locks a removed file
  ::close(descriptor_);
}

Result<FileLock> FileLock::take(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string name =
      (file.parent_path() / ("." + file.filename().string() + ".lock")).string();
  for (;;) {
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor < 0) {
      return make_error(Code::io, std::string("cannot be locked: ") + std::strerror(errno))
          .in_file(path);
    }
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const bool taken = errno == EWOULDBLOCK;
      const std::string reason = std::strerror(errno);
      ::close(descriptor);
      return make_error(Code::io, taken ? "another program is writing to this file; wait for its "
                                          "end, or use another file and merge them"
                                        : "cannot be locked: " + reason)
          .in_file(path);
    }
    FileLock lock(name, descriptor);
    if (still_there(name, descriptor)) return lock;
    ::close(std::exchange(lock.descriptor_, -1));
  }
}

}  // namespace animeme::tools
