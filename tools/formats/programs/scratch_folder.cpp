#include "tools/formats/programs/scratch_folder.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <ctime>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/formats/files/unfinished.h"

namespace animeme::tools {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kBegin = "animeme-";
constexpr double kStale = 24 * 3600;  // seconds

// Whether a folder is one of ours whose process has gone: "animeme-PID-XXXXXX". Processes of a
// container have numbers of their own, so its age counts as well.
bool is_left(const fs::path& path) {
  const std::string name = path.filename().string();
  if (!name.starts_with(kBegin)) return false;
  const char* end = name.data() + name.size();
  pid_t process = 0;
  const auto [rest, error] = std::from_chars(name.data() + kBegin.size(), end, process);
  if (error != std::errc() || process <= 0 || rest == end || *rest != '-') return false;
  struct stat status = {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) return false;
  return status.st_uid == ::geteuid() &&
         std::difftime(std::time(nullptr), status.st_mtime) > kStale && ::kill(process, 0) != 0 &&
         errno == ESRCH;
}

void remove_left(const fs::path& base) {
  std::error_code error;
  std::vector<fs::path> left;
  for (fs::directory_iterator at(base, error), end; !error && at != end; at.increment(error)) {
    if (is_left(at->path())) left.push_back(at->path());
  }
  for (const fs::path& path : left) fs::remove_all(path, error);
}

}  // namespace

Result<std::unique_ptr<ScratchFolder>> ScratchFolder::make() {
  std::error_code error;
  const fs::path found = fs::temp_directory_path(error);
  const fs::path base = error ? fs::path("/tmp") : found;
  static const bool cleaned = (remove_left(base), true);  // once a process
  static_cast<void>(cleaned);
  std::string pattern =
      (base / (std::string(kBegin) + std::to_string(::getpid()) + "-XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    return make_error(Code::io, "no folder for temporary files can be made; set TMPDIR");
  }
  return std::make_unique<ScratchFolder>(fs::path(pattern));
}

ScratchFolder::ScratchFolder(fs::path path)
    : path_(std::move(path)), note_(note_unfinished(path_.string())) {}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  forget_unfinished(note_);
}

}  // namespace animeme::tools
