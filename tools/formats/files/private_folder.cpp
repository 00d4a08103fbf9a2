#include "tools/formats/files/private_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tools/formats/files/output_file.h"

namespace animeme::tools {

namespace fs = std::filesystem;

namespace {

constexpr mode_t kOwnFolder = 0700;
constexpr mode_t kOwnFile = 0600;
constexpr mode_t kOthersWrite = S_IWGRP | S_IWOTH;

// A descriptor that closes itself.
struct Open {
  int descriptor = -1;

  explicit Open(int opened) : descriptor(opened) {}
  Open(const Open&) = delete;
  ~Open() {
    if (descriptor >= 0) ::close(descriptor);
  }
};

Error trouble(const std::string& path, std::string what) {
  return make_error(Code::io, std::move(what)).in_file(path);
}

Error system_trouble(const std::string& path, int reason = errno) {
  if (reason == ELOOP) return trouble(path, "is a link, which is not followed here; remove it");
  if (reason == ENOENT) return make_error(Code::not_found, "there is no such file").in_file(path);
  return trouble(path, std::string("cannot be opened: ") + std::strerror(reason));
}

// Without a slash at its end, where a link would be followed whatever the flags say.
std::string plain(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).string();
}

int open_folder(const std::string& path) {
  return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

Result<void> check_owner(const std::string& path, const struct stat& status) {
  if (status.st_uid != ::geteuid()) return trouble(path, "belongs to another user");
  if ((status.st_mode & kOthersWrite) != 0) {
    return trouble(path, "other users may write to it; take this right from them (chmod go-w)");
  }
  return {};
}

}  // namespace

Result<void> make_private_folder(const std::string& path) {
  const std::string folder = plain(path);
  if (folder.empty()) return trouble(path, "a folder without a name cannot be made");
  fs::path above;
  for (const fs::path& step : fs::path(folder)) {
    above /= step;
    if (::mkdir(above.c_str(), kOwnFolder) != 0 && errno != EEXIST && errno != EISDIR &&
        errno != EACCES && errno != EROFS) {
      return trouble(above.string(), std::string("cannot be made: ") + std::strerror(errno));
    }
  }
  const Open opened(open_folder(folder));
  struct stat status = {};
  if (opened.descriptor < 0 || ::fstat(opened.descriptor, &status) != 0) {
    return system_trouble(folder);
  }
  if (status.st_uid != ::geteuid()) return trouble(folder, "belongs to another user");
  if ((status.st_mode & 07777) != kOwnFolder && ::fchmod(opened.descriptor, kOwnFolder) != 0) {
    return check_owner(folder, status);  // a file system that has no modes
  }
  return {};
}

Result<std::vector<std::uint8_t>> read_private_file(const std::string& path, std::uint64_t most) {
  const std::string folder = plain(fs::path(path).parent_path().string());
  const Open above(open_folder(folder.empty() ? "." : folder));
  struct stat status = {};
  if (above.descriptor < 0 || ::fstat(above.descriptor, &status) != 0) {
    return system_trouble(folder);
  }
  if (auto ok = check_owner(folder, status); !ok) return ok.error();
  // By the folder that was checked; a pipe of that name does not keep us waiting.
  const Open file(::openat(above.descriptor, fs::path(path).filename().c_str(),
                           O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (file.descriptor < 0 || ::fstat(file.descriptor, &status) != 0) return system_trouble(path);
  if (!S_ISREG(status.st_mode)) return trouble(path, "is not an ordinary file");
  if (auto ok = check_owner(path, status); !ok) return ok.error();
  const std::uint64_t size = std::uint64_t(status.st_size);
  if (size > most) {
    return make_error(Code::out_of_range, "is larger than " + std::to_string(most) + " bytes")
        .in_file(path);
  }
  std::vector<std::uint8_t> bytes(size);
  std::size_t read = 0;
  while (read < bytes.size()) {
    const ssize_t count = ::read(file.descriptor, bytes.data() + read, bytes.size() - read);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_trouble(path);
    if (count == 0) break;
    read += std::size_t(count);
  }
  bytes.resize(read);
  return bytes;
}

Result<void> write_private_file(const std::string& path, std::string_view bytes) {
  if (auto ok = make_private_folder(fs::path(path).parent_path().string()); !ok) return ok;
  struct stat status = {};
  // What OutputFile would follow, or write into; a folder it refuses.
  if (::lstat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode) &&
      ::unlink(path.c_str()) != 0) {
    return system_trouble(path);
  }
  OutputFile file(path);
  const Result<std::string> place = file.place();
  if (!place) return place.error();
  if (::chmod(place->c_str(), kOwnFile) != 0) errno = 0;  // vfat has no modes
  if (auto ok = file.write(bytes); !ok) return ok;
  return file.publish();
}

}  // namespace animeme::tools
