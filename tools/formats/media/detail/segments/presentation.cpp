#include "tools/formats/media/detail/segments/presentation.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "tools/formats/media/detail/ffmpeg/extension.h"
#include "tools/formats/media/detail/segments/playlist_text.h"
#include "tools/formats/media/detail/tracks/words_internal.h"

namespace animeme::media {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLongestPlaylist = std::uintmax_t(1) << 24;
constexpr std::uintmax_t kMostPresentation = std::uintmax_t(1) << 30;
constexpr std::size_t kMostRenditions = 64;

using FileBytes = std::vector<std::uint8_t>;

// Files in one folder, up to a number of bytes in all.
class Room {
 public:
  explicit Room(const fs::path& playlist) : name_(playlist.filename()) {
    std::error_code status;
    const fs::path folder = playlist.parent_path();
    root_ = fs::canonical(folder.empty() ? fs::path(".") : folder, status);
  }

  /// Appends what is in an ordinary file of the room. Errors: those of read_presentation().
  Result<void> read(const fs::path& name, FileBytes& out,
                    std::uintmax_t limit = kMostPresentation) {
    std::error_code status;
    const fs::path path = fs::canonical(root_ / name, status);
    if (status) return failed(name, status);
    const auto [end, ignored] = std::mismatch(root_.begin(), root_.end(), path.begin(), path.end());
    if (end != root_.end() || !fs::is_regular_file(path, status)) {
      return make_error(Code::unsupported, "\"" + name.string() +
                                               "\" is not a regular file in the folder of the "
                                               "playlist");
    }
    const std::uintmax_t size = fs::file_size(path, status);
    if (status) return failed(name, status);
    if (size > limit || (total_ += size) > kMostPresentation) {
      return make_error(Code::out_of_range, "the presentation is too large to be read");
    }
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    const std::size_t begin = out.size();
    out.resize(begin + std::size_t(size));
    file.read(reinterpret_cast<char*>(out.data() + begin), std::streamsize(size));
    if (!file) return failed(name, {errno != 0 ? errno : EIO, std::generic_category()});
    return {};
  }

  Result<std::string> read_text(const fs::path& name) {
    FileBytes bytes;
    if (auto done = read(name, bytes, kLongestPlaylist); !done) return done.error();
    return std::string(bytes.begin(), bytes.end());
  }

  const fs::path& name() const { return name_; }

 private:
  static Error failed(const fs::path& name, std::error_code reason) {
    const bool missing =
        reason == std::errc::no_such_file_or_directory || reason == std::errc::not_a_directory;
    return make_error(missing ? Code::not_found : Code::io,
                      "\"" + name.string() + "\" cannot be opened: " + reason.message());
  }

  fs::path root_, name_;
  std::uintmax_t total_ = 0;
};

Result<fs::path> beside(const fs::path& playlist, const std::string& reference) {
  Result<std::string> name = from_reference(reference);
  if (!name) return name.error();
  return playlist.parent_path() / *name;
}

Result<FileBytes> bytes_of(Room& room, const fs::path& playlist, const Rendition& rendition) {
  FileBytes bytes;
  std::vector<std::string> references = rendition.segments;
  if (!rendition.init.empty()) references.insert(references.begin(), rendition.init);
  for (const std::string& reference : references) {
    Result<fs::path> name = beside(playlist, reference);
    if (!name) return name.error();
    if (auto done = room.read(*name, bytes); !done) return done.error();
  }
  return bytes;
}

Result<void> add(Presentation& presentation, Room& room, const fs::path& playlist,
                 const Rendition& rendition) {
  if (presentation.renditions.size() >= kMostRenditions) {
    return make_error(Code::out_of_range, "the playlist names too many renditions");
  }
  Result<FileBytes> bytes = bytes_of(room, playlist, rendition);
  if (!bytes) return bytes.error();
  presentation.renditions.push_back(std::move(*bytes));
  return {};
}

// Face and sound do without a text that cannot be read.
void add_text(Presentation& presentation, Room& room, const fs::path& master,
              const SidecarText& text) {
  const Result<fs::path> playlist = beside(master, text.playlist);
  if (!playlist) return;
  const Result<std::string> content = room.read_text(*playlist);
  if (!content) return;
  const Result<HlsPlaylist> read = read_hls(*content);
  if (!read) return;
  Result<FileBytes> bytes = bytes_of(room, *playlist, read->rendition);
  if (bytes) presentation.texts.push_back({text.name, text.language, std::move(*bytes)});
}

Result<void> add_hls(Presentation& presentation, Room& room, const fs::path& playlist, bool top) {
  Result<std::string> text = room.read_text(playlist);
  if (!text) return text.error();
  Result<HlsPlaylist> read = read_hls(*text);
  if (!read) return read.error().in_file(playlist.string());
  if (read->playlists.empty()) return add(presentation, room, playlist, read->rendition);
  if (!top) return make_error(Code::unsupported, "playlists of playlists of playlists");
  for (const SidecarText& each : read->texts) add_text(presentation, room, playlist, each);
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

const std::vector<std::uint8_t>* find_rendition(const Presentation& presentation, TrackKind kind) {
  const TrackLabels& wanted = wanted_track();
  const std::vector<std::uint8_t>* plain = nullptr;
  for (const std::vector<std::uint8_t>& bytes : presentation.renditions) {
    const Result<ContainerInfo> info = probe(bytes);
    const TrackInfo* track = info ? info->first(kind) : nullptr;
    if (track == nullptr) continue;
    if (wanted.empty() || is_wanted(wanted, track->labels)) return &bytes;
    if (track->labels.empty() && plain == nullptr) plain = &bytes;
  }
  return plain;
}

Result<std::vector<std::uint8_t>> sound_of_playlist(const std::string& path) {
  const Result<Presentation> presentation = read_presentation(path);
  if (!presentation) return presentation.error();
  const std::vector<std::uint8_t>* sound = find_rendition(*presentation, TrackKind::audio);
  if (sound == nullptr) return make_error(Code::not_found, "the presentation has no sound");
  return *sound;
}

std::string to_reference(const std::string& name) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.~/";
  std::string out;
  for (const char c : name) {
    if (kPlain.find(c) != std::string_view::npos) {
      out += c;
    } else {
      out += "%" + to_hex(std::array{std::uint8_t(c)});
    }
  }
  return out;
}

Result<std::string> from_reference(const std::string& reference) {
  const auto outside = [&] {
    return make_error(Code::unsupported,
                      "\"" + reference + "\" is not in the folder of the playlist");
  };
  if (reference.find_first_of(":?#\\") != std::string::npos) return outside();
  std::string out;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (reference[i] != '%') {
      out += reference[i];
      continue;
    }
    const auto code = from_hex(std::string_view(reference).substr(i + 1, 2));
    if (!code || code->empty() || code->front() == 0) {
      return make_error(Code::syntax, "\"" + reference + "\" is not a readable name");
    }
    out += char(code->front());
    i += 2;
  }
  const fs::path path(out);
  const bool up =
      std::any_of(path.begin(), path.end(), [](const fs::path& p) { return p == ".."; });
  if (out.empty() || path.is_absolute() || up) return outside();
  return out;
}

}  // namespace animeme::media
