// Lines out of bytes that come in pieces.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/media/detail/words_internal.h"

namespace animeme::speech {

/// Cuts lines out of bytes as they come, without the blanks around them. A line that is longer than
/// kMostLineBytes is cut at its last blank before that, so what waits is never more.
class LineCutter {
 public:
  static constexpr std::size_t kMostLineBytes = 4000;

  std::vector<std::string> push(std::string_view bytes) {
    rest_ += bytes;
    std::vector<std::string> lines;
    for (;;) {
      std::size_t end = rest_.find('\n');
      std::size_t next = end + 1;
      if (end == std::string::npos && rest_.size() <= kMostLineBytes) return lines;
      if (end > kMostLineBytes) {
        const std::size_t blank = rest_.rfind(' ', kMostLineBytes);
        end = next = blank == std::string::npos || blank == 0 ? kMostLineBytes : blank;
      }
      lines.emplace_back(media::trim(rest_.substr(0, end)));
      rest_.erase(0, next);
    }
  }
  std::string rest() { return std::string(media::trim(std::exchange(rest_, {}))); }

 private:
  std::string rest_;
};

}  // namespace animeme::speech
