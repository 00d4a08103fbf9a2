#include "tools/media/detail/output_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace animeme::media {
namespace fs = std::filesystem;

Result<OutputFile> OutputFile::create(const std::string& path) {
  OutputFile out;
  out.path_ = path;
  std::error_code status;
  if (fs::is_symlink(path, status)) {
    const fs::path target = fs::weakly_canonical(path, status);
    if (!status) out.path_ = target.string();
  }
  if (fs::exists(out.path_, status) && !fs::is_regular_file(out.path_, status)) {
    return make_error(Code::io, "is not an ordinary file; give another name").in_file(path);
  }
  for (int n = 0; n < 1000; ++n) {
    out.temporary_ = out.path_ + ".part" + std::to_string(n);
    std::FILE* file = std::fopen(out.temporary_.c_str(), "wbx");
    if (file != nullptr) {
      std::fclose(file);
      return out;
    }
    if (errno != EEXIST) break;
  }
  const std::string reason = std::strerror(errno);
  out.temporary_.clear();  // not ours
  return make_error(Code::io, "cannot be written: " + reason).in_file(path);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}

OutputFile::~OutputFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

Result<void> OutputFile::commit() {
  std::error_code status;
  fs::rename(temporary_, path_, status);
  if (status) {
    return make_error(Code::io, "cannot be written: " + status.message()).in_file(path_);
  }
  temporary_.clear();
  return {};
}

}  // namespace animeme::media
