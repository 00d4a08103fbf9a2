#include "tools/media/detail/output_folder.h"

#include <filesystem>
#include <system_error>
#include <utility>

namespace animeme::media {
namespace fs = std::filesystem;

namespace {

Error cannot_write(const std::string& path, const std::string& reason) {
  return make_error(Code::io, "cannot be written: " + reason).in_file(path);
}

/// A name that nothing has yet: "<path>.<word>N".
std::string free_name(const std::string& path, const char* word) {
  std::error_code ignored;
  for (int n = 0;; ++n) {
    std::string name = path + "." + word + std::to_string(n);
    if (!fs::exists(fs::symlink_status(name, ignored))) return name;
  }
}

}  // namespace

Result<OutputFolder> OutputFolder::create(const std::string& path, Replaceable replaceable) {
  std::error_code status;
  if (fs::exists(path, status)) {
    if (!fs::is_directory(path, status)) {
      return make_error(Code::io, "is there already and is no folder; give another name")
          .in_file(path);
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(path, status)) {
      if (entry.is_regular_file(status) && replaceable(entry.path().filename().string())) continue;
      return make_error(Code::io, "the folder holds \"" + entry.path().filename().string() +
                                      "\", which is none of its segments; give another name or "
                                      "remove it")
          .in_file(path);
    }
    if (status) return cannot_write(path, status.message());
  }
  OutputFolder out;
  out.path_ = path;
  const std::string name = free_name(path, "part");
  if (!fs::create_directory(name, status)) return cannot_write(path, status.message());
  out.temporary_ = name;
  return out;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      old_(std::exchange(other.old_, {})),
      committed_(std::exchange(other.committed_, false)) {}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  if (committed_) fs::remove_all(path_, ignored);
  if (!old_.empty()) fs::rename(old_, path_, ignored);
}

Result<void> OutputFolder::commit() {
  std::error_code status;
  if (fs::exists(path_, status)) {
    const std::string aside = free_name(path_, "old");
    fs::rename(path_, aside, status);
    if (status) return cannot_write(path_, status.message());
    old_ = aside;
  }
  fs::rename(temporary_, path_, status);
  if (status) return cannot_write(path_, status.message());
  temporary_.clear();
  committed_ = true;
  return {};
}

void OutputFolder::keep() {
  std::error_code ignored;
  if (!old_.empty()) fs::remove_all(old_, ignored);
  old_.clear();
  committed_ = false;
}

}  // namespace animeme::media
