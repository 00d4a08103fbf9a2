#include "tools/formats/exchange/file_kind.h"

#include <algorithm>
#include <string_view>

#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/detail/action_units.h"
#include "tools/formats/exchange/detail/face_packets.h"
#include "tools/formats/exchange/detail/json_curves.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

namespace {

constexpr std::size_t kHead = 4096;  // bytes that are looked at

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Label files and MBROLA's have a word at the end or at the beginning of a line, a header of FAP
// text has numbers at both.
bool ends_in_a_word(std::string_view line) {
  line = line.substr(0, line.find(" #"));  // a comment
  const std::size_t last = line.find_last_not_of(" \t\r");
  if (last == std::string_view::npos) return false;
  const std::size_t begin = line.find_last_of(" \t", last);
  const std::string_view word =
      line.substr(begin == std::string_view::npos ? 0 : begin + 1, last - (begin + 1) + 1);
  return word.find_first_of("0123456789") == std::string_view::npos;
}

}  // namespace

bool is_playlist(std::span<const std::uint8_t> bytes) {
  const std::string_view text = text_of(bytes).substr(0, kHead);
  return text.starts_with("#EXTM3U") ||
         (text.starts_with("<") && text.find("<MPD") != std::string_view::npos);
}

FileKind kind_of(std::span<const std::uint8_t> bytes) {
  const std::string_view whole = text_of(bytes);
  if (whole.starts_with("ANIMEDAM")) return FileKind::model;
  if (is_playlist(bytes)) return FileKind::media;
  if (bytes.size() >= 4 && bytes[0] == 0 && bytes[1] == 0 && bytes[2] == 1) {
    const std::uint32_t code = bytes[3];
    const bool fba = code == 0xB0 || code == 0xB2 || code == 0xB5 || code == 0xBA || code == 0xBB ||
                     code == 0x01 || code == 0x03;
    if (fba) return FileKind::fba_stream;
  }
  // Text has no control bytes but blanks, and of texts only scripts come as UTF-16.
  if (whole.starts_with("\xFF\xFE") || whole.starts_with("\xFE\xFF")) return FileKind::script;
  std::string_view view = whole.substr(0, kHead);
  const bool text = std::none_of(view.begin(), view.end(), [](char c) {
    return std::uint8_t(c) < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\f';
  });
  if (!text) return FileKind::media;
  if (view.starts_with("\xEF\xBB\xBF")) view.remove_prefix(3);
  if (view.find("ooTextFile") != std::string_view::npos) return FileKind::script;
  if (view.starts_with("WEBVTT")) return FileKind::script;
  if (is_face_packets(whole)) return FileKind::curves;
  // A table with a header line of words is a script; FAP text is numbers from its first word on,
  // and to its last.
  while (!view.empty()) {
    const std::size_t end = view.find('\n');
    const std::string_view line = view.substr(0, end);
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string_view::npos && line[first] != '#') {
      // The header of a table of landmarks is longer than the head.
      const std::string_view rest = whole.substr(std::size_t(line.data() - whole.data()));
      if (line.substr(first).starts_with("time_s") || is_arkit_table(line) ||
          is_landmark_table(rest) || is_action_unit_table(line)) {
        return FileKind::curves;
      }
      const char c = line[first];
      if ((c == '{' || c == '[') && looks_like_json_curves(rest)) return FileKind::curves;
      const bool number = (c >= '0' && c <= '9') || c == '-' || c == '.';
      if (!number || ends_in_a_word(line) || view.find("-->") != std::string_view::npos) {
        return FileKind::script;
      }
      const std::string_view version =
          line.substr(first, line.find_first_of(" \t\r", first) - first);
      return version == "3.1" || version == "3.2" ? FileKind::bap_text : FileKind::fap_text;
    }
    if (end == std::string_view::npos) break;
    view.remove_prefix(end + 1);
  }
  return FileKind::unknown;
}

}  // namespace animeme::exchange
