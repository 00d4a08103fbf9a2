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

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return out;
}

std::string in_quotes(std::string_view token) {
  constexpr std::size_t longest = 32;
  std::string text = "'";
  for (const char c : token.substr(0, longest)) text += c < ' ' || c > '~' ? '?' : c;
  return text + (token.size() > longest ? "...'" : "'");
}

std::optional<bool> unmarked_utf16(std::string_view bytes) {
  bytes = bytes.substr(0, 4096);
  std::size_t zeros[2] = {0, 0};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == 0) ++zeros[i % 2];
  }
  if ((zeros[0] == 0) == (zeros[1] == 0)) return std::nullopt;
  if (zeros[0] + zeros[1] < 2 || 16 * (zeros[0] + zeros[1]) < bytes.size()) return std::nullopt;
  return zeros[0] > 0;
}

}  // namespace animeme::fap::detail
