// Files are opened once and asked what they are, so that nothing can change in between; what is no
// ordinary file is not waited for.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tools/view/gltf/detail/container.h"
#include "tools/view/gltf/detail/file.h"

namespace animeme::gltf {

namespace fs = std::filesystem;

namespace {

class OpenFile {
 public:
  explicit OpenFile(const std::string& path)
      : path_(path), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    if (file_ < 0) error_ = errno;
    if (file_ >= 0 && ::fstat(file_, &status_) != 0) status_ = {};
  }
  OpenFile(const OpenFile&) = delete;
  ~OpenFile() {
    if (file_ >= 0) ::close(file_);
  }

  /// Nothing if it is an ordinary file or, with `pipes`, what has no size.
  std::optional<Error> trouble(bool pipes) const {
    if (file_ < 0) {
      if (error_ == ENOENT || error_ == ENOTDIR) {
        return make_error(Code::not_found, "there is no file " + path_);
      }
      return failed(error_);
    }
    if (S_ISDIR(status_.st_mode)) return make_error(Code::not_found, path_ + " is a folder");
    if (pipes || S_ISREG(status_.st_mode)) return std::nullopt;
    return make_error(Code::io, path_ + " is not a regular file");
  }

  bool has_size() const { return S_ISREG(status_.st_mode); }
  std::size_t size() const { return std::size_t(status_.st_size); }
  /// Appends until there are `wanted` bytes or the file ends. Pipes are waited for only while
  /// another process writes into them.
  Result<void> read(Bytes& bytes, std::size_t wanted) {
    constexpr std::size_t kBlock = 1 << 20;
    if (!has_size()) ::fcntl(file_, F_SETFL, 0);
    while (bytes.size() < wanted) {
      const std::size_t had = bytes.size();
      // What claims to be large is believed bit by bit.
      const std::size_t most = has_size() ? std::max(size(), had + 1) : had + kBlock;
      bytes.resize(std::min(wanted, most));
      const ssize_t got = ::read(file_, bytes.data() + had, bytes.size() - had);
      bytes.resize(had + std::size_t(std::max<ssize_t>(got, 0)));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return failed(errno);
      if (got == 0) break;
    }
    return {};
  }

 private:
  Error failed(int error) const {
    return make_error(Code::io, "cannot read " + path_ + ": " + std::strerror(error));
  }

  std::string path_;
  int file_;
  int error_ = 0;
  struct stat status_ {};
};

Error too_long(std::size_t most) {
  return make_error(Code::out_of_range,
                    "the file has more than " + million_text(most) +
                        " bytes, the most that are read: leave out what is not the head");
}

}  // namespace

Result<Bytes> bytes_of(const std::string& path, std::size_t most) {
  constexpr std::size_t kFirst = 12, kBlank = 1000;
  OpenFile file(path);
  if (auto error = file.trouble(true)) return std::move(*error);
  Bytes bytes;
  if (auto done = file.read(bytes, std::min(kFirst, most)); !done) return done.error();
  const std::optional<std::size_t> length = glb_length(bytes);
  if (!length) {
    if (auto done = file.read(bytes, std::min(kBlank, most)); !done) return done.error();
  }
  // Nothing more comes of what is no glTF.
  if (!length && !looks_like_json(bytes)) return bytes;
  const std::size_t size = file.has_size() ? file.size() : most + 1;
  const std::size_t wanted = length ? std::min(*length, size) : size;
  if (length ? *length > most : file.has_size() && size > most) return too_long(most);
  if (auto done = file.read(bytes, wanted); !done) return done.error();
  if (bytes.size() > most) return too_long(most);
  return bytes;
}

LoadFile files_of(std::string folder, std::size_t most) {
  return [folder = std::move(folder), most](const std::string& uri) -> Result<Bytes> {
    if (uri.find("://") != std::string::npos) {
      return make_error(Code::unsupported,
                        "files from the web are not loaded: save " + uri + " next to the head");
    }
    const auto outside = [&] {
      return make_error(Code::unsupported, "\"" + uri +
                                               "\" is outside the folder of the head: "
                                               "move it there");
    };
    const fs::path path = fs::path(uri).lexically_normal();
    if (path.is_absolute() || path.empty() || *path.begin() == "..") return outside();
    // Links are followed within the folder only.
    std::error_code code;
    const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : fs::path(folder), code);
    const fs::path place = fs::canonical(root / path, code);
    if (code)
      return make_error(Code::not_found, "there is no file " + (fs::path(folder) / path).string());
    if (std::mismatch(root.begin(), root.end(), place.begin(), place.end()).first != root.end()) {
      return outside();
    }
    OpenFile file(place.string());
    if (auto error = file.trouble(false)) return std::move(*error);
    if (file.size() > most) return too_long(most);
    Bytes bytes;
    if (auto done = file.read(bytes, file.size()); !done) return done.error();
    return bytes;
  };
}

}  // namespace animeme::gltf
