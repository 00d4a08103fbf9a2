#include "tools/formats/files/output_folder.h"

#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tools/formats/files/output_file.h"
#include "tools/formats/files/unfinished.h"
#include "tools/formats/files/unforeseen_name_internal.h"

namespace animeme::tools {
namespace fs = std::filesystem;

namespace {

Error cannot_write(const std::string& path, const std::string& reason) {
  return make_error(Code::io, "cannot be written: " + reason).in_file(path);
}

std::string name_beside(const std::string& path) {
  return (fs::path(path).parent_path() / unforeseen_name()).string();
}

}  // namespace

Result<void> try_output_folder(const std::string& path) {
  std::error_code status;
  fs::path nearest = fs::absolute(path, status);
  while (!fs::exists(fs::symlink_status(nearest, status)) && nearest.has_relative_path()) {
    nearest = nearest.parent_path();
  }
  if (!fs::is_directory(nearest, status)) {
    return make_error(Code::io, nearest.string() + " is not a folder; give another name")
        .in_file(path);
  }
  auto can = try_output((nearest / unforeseen_name()).string());
  if (!can) return make_error(Code::io, can.error().message).in_file(path);
  return {};
}

Result<OutputFolder> OutputFolder::create(const std::string& path, Replaceable replaceable) {
  std::error_code status;
  if (fs::exists(path, status)) {
    if (!fs::is_directory(path, status)) {
      return make_error(Code::io, "is there already and is not a folder; give another name")
          .in_file(path);
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(path, status)) {
      if (entry.is_regular_file(status) && replaceable(entry.path().filename().string())) continue;
      return make_error(Code::io, "the folder holds \"" + entry.path().filename().string() +
                                      "\", which is not one of its segments; give another name or "
                                      "remove it")
          .in_file(path);
    }
    if (status) return cannot_write(path, status.message());
  }
  OutputFolder out;
  out.path_ = path;
  const std::string name = name_beside(path);
  // create_directory() is content with a folder that is there already.
  if (::mkdir(name.c_str(), 0777) != 0) {
    return cannot_write(path, std::generic_category().message(errno));
  }
  out.temporary_ = name;
  out.note_ = note_unfinished(name);
  return out;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      note_(std::exchange(other.note_, 0)),
      old_(std::exchange(other.old_, {})),
      committed_(std::exchange(other.committed_, false)) {}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  forget_unfinished(note_);
  if (committed_) fs::remove_all(path_, ignored);
  if (!old_.empty()) fs::rename(old_, path_, ignored);
}

Result<void> OutputFolder::commit() {
  std::error_code status;
  if (fs::exists(path_, status)) {
    const std::string aside = name_beside(path_);
    fs::rename(path_, aside, status);
    if (status) return cannot_write(path_, status.message());
    old_ = aside;
  }
  fs::rename(temporary_, path_, status);
  if (status) return cannot_write(path_, status.message());
  temporary_.clear();
  forget_unfinished(std::exchange(note_, 0));
  committed_ = true;
  return {};
}

void OutputFolder::keep() {
  std::error_code ignored;
  if (!old_.empty()) fs::remove_all(old_, ignored);
  old_.clear();
  committed_ = false;
}

}  // namespace animeme::tools
