#include "tools/formats/files/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <utility>

#include "tools/formats/files/unfinished.h"
#include "tools/formats/files/unforeseen_name_internal.h"

namespace animeme::tools {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLinks = 40;  // one behind the other, as the kernel has it
constexpr int kMostNames = 100;

const char* remedy_of(int reason) {
  switch (reason) {
    case ENOENT:
      return "; is there such a folder?";
    case EACCES:
    case EROFS:
      return "; files are made in their folder, which must be writable";
    case ENOSPC:
    case EDQUOT:
      return "; free some space or write to another disk";
    case EFBIG:
      return "; the file system or a limit of the shell (ulimit -f) allows no larger file";
    default:
      return "";
  }
}

Error output_error(const std::string& path, int reason = errno) {
  return make_error(Code::io,
                    std::string("cannot write: ") + std::strerror(reason) + remedy_of(reason))
      .in_file(path);
}

Result<void> write_stdout(std::span<const std::uint8_t> bytes) {
  const std::size_t written = std::fwrite(bytes.data(), 1, bytes.size(), stdout);
  if (written == bytes.size() && std::fflush(stdout) == 0) return {};
  return output_error("standard output");
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// What a chain of links leads to; it need not be there.
fs::path follow_links(fs::path path) {
  std::error_code status;
  for (int i = 0; i < kMostLinks && fs::is_symlink(path, status); ++i) {
    const fs::path next = fs::read_symlink(path, status);
    if (status) break;
    path = path.parent_path() / next;  // an absolute one stands for itself
  }
  return path;
}

bool write_all(int descriptor, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes = bytes.subspan(std::size_t(count));
  }
  return true;
}

// Keeps owner and permissions.
void keep_mode(int descriptor, const struct stat& old) {
  // To give a file away takes rights that few have; its mode is kept by all.
  if (::fchown(descriptor, old.st_uid, old.st_gid) != 0) errno = 0;
  if (::fchmod(descriptor, old.st_mode & 07777) != 0) errno = 0;  // vfat has no modes
}

// A new name is safe on the disk once its folder is. Not all file systems know that.
void sync_folder(const fs::path& folder) {
  const int descriptor =
      ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      note_(std::exchange(other.note_, 0)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile::~OutputFile() { forget(); }

void OutputFile::forget() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  forget_unfinished(std::exchange(note_, 0));
}

Result<void> OutputFile::open() {
  if (descriptor_ >= 0) return {};
  if (path_.empty()) return make_error(Code::io, "a file without a name cannot be written");
  struct stat old = {};
  const bool there = ::stat(path_.c_str(), &old) == 0;
  if (there && S_ISDIR(old.st_mode)) {
    return make_error(Code::io, "this is a folder; give the name of a file").in_file(path_);
  }
  if (there && !S_ISREG(old.st_mode)) {
    // Devices and pipes cannot be renamed onto.
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    return descriptor_ >= 0 ? Result<void>() : output_error(path_);
  }
  target_ = follow_links(path_).string();
  std::error_code unknown;
  if (fs::is_symlink(target_, unknown)) return output_error(path_, ELOOP);
  for (int i = 0; i < kMostNames && descriptor_ < 0; ++i) {
    temporary_ = (fs::path(target_).parent_path() / unforeseen_name()).string();
    descriptor_ =
        ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ < 0) {
    temporary_.clear();  // not ours
    return output_error(path_);
  }
  note_ = note_unfinished(temporary_);
  if (there) keep_mode(descriptor_, old);
  return {};
}

Result<void> OutputFile::write(std::span<const std::uint8_t> bytes) {
  if (path_ == "-") return write_stdout(bytes);
  if (auto opened = open(); !opened) return opened;
  return write_all(descriptor_, bytes) ? Result<void>() : output_error(path_);
}

Result<void> OutputFile::write(std::string_view text) { return write(bytes_of(text)); }

Result<std::string> OutputFile::place() {
  const char* kOrdinary = "is not an ordinary file; give another name";
  if (path_ == "-") return make_error(Code::io, kOrdinary).in_file("standard output");
  if (auto opened = open(); !opened) return opened.error();
  if (temporary_.empty()) return make_error(Code::io, kOrdinary).in_file(path_);
  return temporary_;
}

Result<void> OutputFile::publish() {
  if (path_ == "-") return {};
  if (auto opened = open(); !opened) return opened;
  if (temporary_.empty()) {
    return ::close(std::exchange(descriptor_, -1)) == 0 ? Result<void>() : output_error(path_);
  }
  // A file system without fsync says EINVAL.
  const bool safe = ::fsync(descriptor_) == 0 || errno == EINVAL;
  if (!safe || ::close(std::exchange(descriptor_, -1)) != 0 ||
      ::rename(temporary_.c_str(), target_.c_str()) != 0) {
    const Error error = output_error(path_);
    forget();
    return error;
  }
  temporary_.clear();
  forget();
  sync_folder(fs::path(target_).parent_path());
  return {};
}

Result<void> try_output(const std::string& path) {
  struct stat there = {};
  const bool dash = path == "-";
  if (!dash && ::stat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode) &&
      !S_ISDIR(there.st_mode)) {
    // Who reads from a pipe would take its being closed for the end.
    if (!S_ISCHR(there.st_mode)) {
      return ::access(path.c_str(), W_OK) == 0 ? Result<void>() : output_error(path);
    }
    const int device = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    const bool takes = device >= 0 && ::write(device, "", 0) == 0;
    const int reason = errno;
    if (device >= 0) ::close(device);
    return takes ? Result<void>() : output_error(path, reason);
  }
  if (dash) {
    const bool takes = ::write(STDOUT_FILENO, "", 0) == 0;
    return takes ? Result<void>() : output_error("standard output");
  }
  constexpr std::array<std::uint8_t, 4096> kBlock =
      {};  // where not even that is free, the disk is full
#ifdef O_TMPFILE
  // Without a name nothing stays, even if the program is killed here.
  if (::lstat(path.c_str(), &there) != 0 && errno == ENOENT) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    const int nameless =
        ::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    const bool takes =
        nameless >= 0 && ::write(nameless, kBlock.data(), kBlock.size()) == ssize_t(kBlock.size());
    if (nameless >= 0) ::close(nameless);
    if (takes) return {};
  }
#endif
  return OutputFile(path).write(kBlock);
}

Result<void> flush_standard_output() {
  errno = 0;
  std::cout.flush();
  const bool done = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && !std::cout.bad();
  if (done) return {};
  // The reason of a write that failed before is asked for again.
  const bool fails = errno != 0 || ::write(STDOUT_FILENO, "", 0) != 0;
  return output_error("standard output", fails ? errno : EIO);
}

Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  OutputFile file(path);
  if (auto done = file.write(bytes); !done) return done;
  return file.publish();
}

Result<void> write_file(const std::string& path, std::string_view text) {
  return write_file(path, bytes_of(text));
}

Result<void> write_files(std::span<const OutputText> files) {
  std::vector<OutputFile> staged;
  for (const OutputText& file : files) {
    if (file.path == "-") continue;
    staged.emplace_back(file.path);
    if (auto done = staged.back().write(file.text); !done) return done;
  }
  for (const OutputText& file : files) {
    if (file.path != "-") continue;
    if (auto done = write_stdout(bytes_of(file.text)); !done) return done;
  }
  for (OutputFile& file : staged) {
    if (auto done = file.publish(); !done) return done;
  }
  return {};
}

}  // namespace animeme::tools
