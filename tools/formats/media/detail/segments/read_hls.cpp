// Reading HLS playlists, the small part of them that local files need.
#include <optional>

#include "tools/formats/media/detail/segments/playlist_text.h"

namespace animeme::media {
namespace {

constexpr std::size_t kMostTexts = 32;

class HlsReader {
 public:
  Result<HlsPlaylist> read(std::string_view text);

 private:
  Result<void> take(std::string_view line);
  Result<void> take_tag(std::string_view line);
  Error wrong(Code code, const std::string& what) const { return error_at_line(code, what, line_); }

  HlsPlaylist out_;
  std::int64_t line_ = 0;
  bool variant_next_ = false;
  bool master_ = false;
};

/// Value of NAME="value" in an attribute list; quoted strings may hold commas.
std::optional<std::string> attribute(std::string_view list, std::string_view name) {
  while (!list.empty()) {
    const std::size_t equals = list.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const std::string_view key = list.substr(0, equals);
    list.remove_prefix(equals + 1);
    std::string_view value;
    if (!list.empty() && list.front() == '"') {
      const std::size_t end = list.find('"', 1);
      if (end == std::string_view::npos) return std::nullopt;
      value = list.substr(1, end - 1);
      list.remove_prefix(end + 1);
    } else {
      value = list.substr(0, list.find(','));
      list.remove_prefix(value.size());
    }
    if (key == name) return std::string(value);
    if (!list.empty()) list.remove_prefix(1);  // the comma
  }
  return std::nullopt;
}

bool skip_prefix(std::string_view& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return false;
  text.remove_prefix(prefix.size());
  return true;
}

Result<void> HlsReader::take_tag(std::string_view line) {
  if (skip_prefix(line, "#EXT-X-STREAM-INF:")) {
    variant_next_ = master_ = true;
  } else if (skip_prefix(line, "#EXT-X-MEDIA:")) {
    master_ = true;
    const auto uri = attribute(line, "URI");
    const bool text = attribute(line, "TYPE") == "SUBTITLES";
    if (uri && text && out_.texts.size() < kMostTexts) {
      out_.texts.push_back(
          {*uri, attribute(line, "NAME").value_or(""), attribute(line, "LANGUAGE").value_or("")});
    }
    if (uri && !text) out_.playlists.push_back(*uri);
  } else if (skip_prefix(line, "#EXT-X-MAP:")) {
    const auto uri = attribute(line, "URI");
    if (!uri) return wrong(Code::syntax, "EXT-X-MAP has no URI");
    if (attribute(line, "BYTERANGE")) return wrong(Code::unsupported, "byte ranges are not read");
    if (!out_.rendition.init.empty() && out_.rendition.init != *uri) {
      return wrong(Code::unsupported, "a second initialization segment is not read");
    }
    out_.rendition.init = *uri;
  } else if (line.starts_with("#EXT-X-BYTERANGE")) {
    return wrong(Code::unsupported,
                 "byte ranges are not supported; put each segment in its own file");
  } else if (skip_prefix(line, "#EXT-X-KEY:")) {
    if (attribute(line, "METHOD") != "NONE") {
      return wrong(Code::unsupported, "encrypted segments are not read");
    }
  }
  return {};  // other tags do not change what is read
}

Result<void> HlsReader::take(std::string_view line) {
  if (line.empty()) return {};
  if (line.front() == '#') return take_tag(line);
  if (out_.rendition.segments.size() + out_.playlists.size() >= kMostSegments) {
    return wrong(Code::out_of_range, "the playlist is too long");
  }
  if (variant_next_) {
    out_.playlists.emplace_back(line);
    variant_next_ = false;
  } else {
    out_.rendition.segments.emplace_back(line);
  }
  return {};
}

Result<HlsPlaylist> HlsReader::read(std::string_view text) {
  skip_prefix(text, "\xEF\xBB\xBF");
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) {
      line.remove_suffix(1);
    }
    if (++line_ == 1) {
      if (line != "#EXTM3U") return wrong(Code::syntax, "a playlist begins with #EXTM3U");
      continue;
    }
    if (auto taken = take(line); !taken) return taken.error();
  }
  if (line_ == 0) return wrong(Code::truncated, "the playlist is empty");
  if (master_ && !out_.rendition.segments.empty()) {
    return make_error(Code::syntax, "the playlist mixes segments and other playlists");
  }
  if (out_.playlists.empty() && out_.rendition.segments.empty()) {
    return make_error(Code::truncated, "the playlist names no segments");
  }
  return std::move(out_);
}

}  // namespace

Result<HlsPlaylist> read_hls(std::string_view text) { return HlsReader().read(text); }

}  // namespace animeme::media
