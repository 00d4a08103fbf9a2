#include "tools/characters/capture/tracked_cache.h"

#include <filesystem>

#include "tools/formats/files/files.h"

namespace animeme::tools {

namespace {

namespace fs = std::filesystem;

std::string key_of(const std::string& video, const CaptureSettings& settings) {
  std::error_code error;
  const auto size = fs::file_size(video, error);
  const auto time = fs::last_write_time(video, error);
  if (error) return {};
  return "video\t" + fs::path(video).filename().string() + "\nsize\t" + std::to_string(size) +
         "\ntime\t" + std::to_string(time.time_since_epoch().count()) + "\ntracker\t" +
         (settings.tracker ? settings.tracker->command() : "") + "\n";
}

}  // namespace

std::optional<std::string> TrackedCache::find(const std::string& id, const std::string& video,
                                              const CaptureSettings& settings) const {
  if (forget) return std::nullopt;
  const auto key = read_text_file(folder + "/" + id + ".key", kMostWritten);
  if (!key || key->empty() || *key != key_of(video, settings)) return std::nullopt;
  auto table = read_text_file(folder + "/" + id + ".csv");
  if (!table) return std::nullopt;
  return std::move(*table);
}

Result<void> TrackedCache::keep(const std::string& id, const std::string& video,
                                const CaptureSettings& settings, const std::string& table) const {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    return make_error(Code::io, "the folder cannot be made: " + error.message()).in_file(folder);
  }
  // The key last: a table without a key is ignored.
  if (auto ok = write_file(folder + "/" + id + ".csv", table); !ok) return ok;
  return write_file(folder + "/" + id + ".key", key_of(video, settings));
}

}  // namespace animeme::tools
