// Lines out of bytes that come in pieces.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/formats/media/detail/tracks/words_internal.h"
#include "tools/speech/talking/line_command.h"

namespace animeme::speech {

/// Where a text of more than `most` bytes is cut: behind its last sentence in the first half of
/// them, else behind its first one there, else at its last blank, else in front of a character.
inline std::size_t place_of_cut(std::string_view text, std::size_t most) {
  constexpr std::string_view kEnds[] = {". ", "! ", "? ", "\n", "\u3002", "\uFF01", "\uFF1F"};
  std::size_t early = 0, late = most + 1;
  for (const std::string_view sign : kEnds) {
    const std::size_t before = text.substr(0, most / 2).rfind(sign);
    if (before != std::string_view::npos) early = std::max(early, before + sign.size());
    const std::size_t behind = text.substr(0, most).find(sign, most / 2);
    if (behind != std::string_view::npos) late = std::min(late, behind + sign.size());
  }
  if (early > most / 8) return early;
  if (late <= most) return late;
  const std::size_t blank = text.rfind(' ', most);
  if (blank != std::string_view::npos && blank > 0) return blank;
  std::size_t end = most;
  while (end > 1 && (std::uint8_t(text[end]) & 0xC0U) == 0x80U) --end;
  return end;
}

/// Leaves at most `most` bytes of a text; what stands before goes to `lines`.
inline void cut_at_blanks(std::string& text, std::size_t most, std::vector<std::string>& lines) {
  while (text.size() > most) {
    const std::size_t end = place_of_cut(text, most);
    lines.emplace_back(media::trim(text.substr(0, end)));
    text.erase(0, end);
  }
}

/// Cuts lines out of bytes as they come, without the blanks around them. What waits is never more
/// than `most` bytes: a line that is longer is cut behind a sentence or at a blank before that; or,
/// without `cut`, its first `most` + 1 bytes stand for it and the rest is dropped. With `cut`, one
/// that begins with { may be a command and is treated so, too, with kMostCommand.
class LineCutter {
 public:
  LineCutter(std::size_t most, bool cut) : most_(most), cut_(cut) {}

  std::vector<std::string> push(std::string_view bytes) {
    std::vector<std::string> lines;
    while (!bytes.empty()) {
      const std::size_t end = bytes.find('\n');
      append(bytes.substr(0, end), lines);
      if (end == std::string_view::npos) break;
      lines.push_back(rest());
      bytes.remove_prefix(end + 1);
    }
    return lines;
  }
  std::string rest() { return std::string(media::trim(std::exchange(rest_, {}))); }

 private:
  void append(std::string_view bytes, std::vector<std::string>& lines) {
    if (!cut_) return append_up_to(most_, bytes);
    if (may_be_command(rest_.empty() ? bytes : rest_)) return append_up_to(kMostCommand, bytes);
    rest_ += bytes;
    cut_at_blanks(rest_, most_, lines);
  }

  void append_up_to(std::size_t most, std::string_view bytes) {
    rest_ += bytes.substr(0, most + 1 - std::min(rest_.size(), most + 1));
  }
  static bool may_be_command(std::string_view line) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    return first != std::string_view::npos && line[first] == '{';
  }

  std::size_t most_;
  bool cut_;
  std::string rest_;
};

}  // namespace animeme::speech
