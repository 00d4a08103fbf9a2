#include "tools/media/detail/presentation.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "tools/media/detail/extension.h"
#include "tools/media/detail/playlist_text.h"

namespace animeme::media {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLongestPlaylist = std::uintmax_t(1) << 24;
constexpr std::uintmax_t kMostPresentation = std::uintmax_t(1) << 30;
constexpr std::size_t kMostRenditions = 16;

using FileBytes = std::vector<std::uint8_t>;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// Files in one folder, up to a number of bytes in all.
class Room {
 public:
  explicit Room(const fs::path& playlist) : name_(playlist.filename()) {
    std::error_code status;
    const fs::path folder = playlist.parent_path();
    root_ = fs::canonical(folder.empty() ? fs::path(".") : folder, status);
  }

  struct File {
    fs::path path;
    std::size_t size = 0;
  };

  /// An ordinary file of the room. Its size counts for the limit. Errors: those of
  /// read_presentation().
  Result<File> find(const fs::path& name, std::uintmax_t limit) {
    std::error_code status;
    File file;
    file.path = fs::canonical(root_ / name, status);
    if (status) return failed(name, status.value());
    const auto [end, ignored] =
        std::mismatch(root_.begin(), root_.end(), file.path.begin(), file.path.end());
    if (end != root_.end() || !fs::is_regular_file(file.path, status)) {
      return make_error(Code::unsupported, "\"" + name.string() +
                                               "\" is no ordinary file in the folder of the "
                                               "playlist");
    }
    const std::uintmax_t size = fs::file_size(file.path, status);
    if (status) return failed(name, status.value());
    if (size > limit || (total_ += size) > kMostPresentation) {
      return make_error(Code::out_of_range, "the presentation is too large to be read");
    }
    file.size = std::size_t(size);
    return file;
  }

  /// Appends what is in a file. Errors: not_found, io.
  Result<void> read(const File& found, FileBytes& out) const {
    const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(found.path.c_str(), "rb"));
    if (!file) return failed(found.path.filename(), errno);
    const std::size_t begin = out.size();
    out.resize(begin + found.size);
    const std::size_t got = std::fread(out.data() + begin, 1, found.size, file.get());
    out.resize(begin + got);
    if (std::ferror(file.get()) != 0) return failed(found.path.filename(), EIO);
    return {};
  }

  Result<std::string> read_text(const fs::path& name) {
    FileBytes bytes;
    Result<File> file = find(name, kLongestPlaylist);
    if (!file) return file.error();
    if (auto done = read(*file, bytes); !done) return done.error();
    return std::string(bytes.begin(), bytes.end());
  }

  const fs::path& name() const { return name_; }

 private:
  static Error failed(const fs::path& name, int reason) {
    const Code code = reason == ENOENT || reason == ENOTDIR ? Code::not_found : Code::io;
    return make_error(code, "\"" + name.string() + "\" cannot be opened: " + std::strerror(reason));
  }

  fs::path root_, name_;
  std::uintmax_t total_ = 0;
};

Result<fs::path> beside(const fs::path& playlist, const std::string& reference) {
  Result<std::string> name = from_reference(reference);
  if (!name) return name.error();
  return playlist.parent_path() / *name;
}

Result<FileBytes> join(Room& room, const fs::path& playlist, const Rendition& rendition) {
  FileBytes bytes;
  std::vector<std::string> references;
  if (!rendition.init.empty()) references.push_back(rendition.init);
  references.insert(references.end(), rendition.segments.begin(), rendition.segments.end());
  // Sizes first, so that what is too large is not read at all.
  std::vector<Room::File> files;
  std::size_t size = 0;
  for (const std::string& reference : references) {
    Result<fs::path> name = beside(playlist, reference);
    if (!name) return name.error();
    Result<Room::File> file = room.find(*name, kMostPresentation);
    if (!file) return file.error();
    size += file->size;
    files.push_back(std::move(*file));
  }
  bytes.reserve(size);
  for (const Room::File& file : files) {
    if (auto read = room.read(file, bytes); !read) return read.error();
  }
  return bytes;
}

Result<void> add(Presentation& presentation, Room& room, const fs::path& playlist,
                 const Rendition& rendition) {
  if (presentation.renditions.size() >= kMostRenditions) {
    return make_error(Code::out_of_range, "the playlist names too many renditions");
  }
  Result<FileBytes> bytes = join(room, playlist, rendition);
  if (!bytes) return bytes.error();
  presentation.renditions.push_back(std::move(*bytes));
  return {};
}

Result<void> add_hls(Presentation& presentation, Room& room, const fs::path& playlist, bool top) {
  Result<std::string> text = room.read_text(playlist);
  if (!text) return text.error();
  Result<HlsPlaylist> read = read_hls(*text);
  if (!read) return read.error().in_file(playlist.string());
  if (read->playlists.empty()) return add(presentation, room, playlist, read->rendition);
  if (!top) return make_error(Code::unsupported, "playlists of playlists of playlists");
  std::vector<std::string> seen;
  for (const std::string& reference : read->playlists) {
    if (std::find(seen.begin(), seen.end(), reference) != seen.end()) continue;
    seen.push_back(reference);
    Result<fs::path> name = beside(playlist, reference);
    if (!name) return name.error();
    if (auto added = add_hls(presentation, room, *name, false); !added) return added;
  }
  return {};
}

Result<void> add_dash(Presentation& presentation, Room& room) {
  Result<std::string> text = room.read_text(room.name());
  if (!text) return text.error();
  Result<std::vector<Rendition>> renditions = read_dash(*text);
  if (!renditions) return renditions.error();
  for (const Rendition& rendition : *renditions) {
    if (auto added = add(presentation, room, room.name(), rendition); !added) return added;
  }
  return {};
}

}  // namespace

bool is_playlist(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".m3u8" || extension == ".mpd";
}

Result<Presentation> read_presentation(const std::string& path) {
  Presentation presentation;
  const bool dash = extension_of(path) == ".mpd";
  presentation.format = dash ? "dash" : "hls";
  Room room{fs::path(path)};
  Result<void> added =
      dash ? add_dash(presentation, room) : add_hls(presentation, room, room.name(), true);
  if (!added) return std::move(added.error()).in_file(path);
  return presentation;
}

std::string to_reference(const std::string& name) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.~/";
  std::string out;
  for (const char c : name) {
    if (kPlain.find(c) != std::string_view::npos) {
      out += c;
      continue;
    }
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", unsigned(static_cast<unsigned char>(c)));
    out += code;
  }
  return out;
}

Result<std::string> from_reference(const std::string& reference) {
  const auto outside = [&] {
    return make_error(Code::unsupported,
                      "\"" + reference + "\" does not lie in the folder of the playlist");
  };
  if (reference.find_first_of(":?#\\") != std::string::npos) return outside();
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (reference[i] != '%') {
      out += reference[i];
      continue;
    }
    const int high = i + 2 < reference.size() ? digit(reference[i + 1]) : -1;
    const int low = high < 0 ? -1 : digit(reference[i + 2]);
    if (low < 0 || high * 16 + low == 0) {
      return make_error(Code::syntax, "\"" + reference + "\" is no name that can be read");
    }
    out += char(high * 16 + low);
    i += 2;
  }
  const fs::path path(out);
  const bool up =
      std::any_of(path.begin(), path.end(), [](const fs::path& p) { return p == ".."; });
  if (out.empty() || path.is_absolute() || up) return outside();
  return out;
}

}  // namespace animeme::media
