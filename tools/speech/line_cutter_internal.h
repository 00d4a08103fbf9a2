// Lines out of bytes that come in pieces.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/media/detail/words_internal.h"

namespace animeme::speech {

/// Cuts lines out of bytes as they come, without the blanks around them. What waits is never more
/// than `most` bytes: a line that is longer is cut at its last blank before that; or, without
/// `cut`, its first `most` + 1 bytes stand for it and the rest is dropped.
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
    if (!cut_) {
      rest_ += bytes.substr(0, most_ + 1 - std::min(rest_.size(), most_ + 1));
      return;
    }
    rest_ += bytes;
    while (rest_.size() > most_) {
      const std::size_t blank = rest_.rfind(' ', most_);
      const std::size_t end = blank == std::string::npos || blank == 0 ? most_ : blank;
      lines.emplace_back(media::trim(rest_.substr(0, end)));
      rest_.erase(0, end);
    }
  }

  std::size_t most_;
  bool cut_;
  std::string rest_;
};

}  // namespace animeme::speech
