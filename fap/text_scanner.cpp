#include "fap/detail/text_scanner.h"

#include <cstddef>

namespace animeme::fap::detail {

bool TextScanner::to_content() {
  for (;;) {
    skip_blanks();
    if (at_end()) return false;
    if (*at_ == '#') {
      skip_line();
    } else if (is_line_end(*at_)) {
      pass_line_end();
    } else {
      return true;
    }
  }
}

std::string_view TextScanner::token() {
  skip_blanks();
  if (at_end() || is_line_end(*at_) || *at_ == '#') return {};
  const char* begin = at_;
  while (!at_end() && !is_blank(*at_) && !is_line_end(*at_)) ++at_;
  token_begin_ = begin;
  return {begin, std::size_t(at_ - begin)};
}

}  // namespace animeme::fap::detail
