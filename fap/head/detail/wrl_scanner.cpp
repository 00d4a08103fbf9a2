#include "fap/head/detail/wrl_scanner.h"

#include <algorithm>
#include <limits>

#include "fap/detail/real_text.h"

namespace animeme::head::detail {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ','; }

bool ends_word(char c) {
  return is_blank(c) || c == '{' || c == '}' || c == '[' || c == ']' || c == '"' || c == '#';
}

std::optional<double> number_of(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  // from_chars would also take "inf" and "nan", which are words here.
  const char first = token.empty() ? ' ' : token.front();
  if (first != '-' && first != '.' && (first < '0' || first > '9')) return {};
  if (first == '-' && token.size() > 1 && token[1] > '9') return {};
  double value = 0;
  const auto [end, code] = fap::detail::read_real(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size()) return {};
  if (code == std::errc::result_out_of_range) {
    const bool small = token.find("e-") != token.npos || token.find("E-") != token.npos;
    return small ? 0 : std::numeric_limits<double>::infinity();
  }
  return code == std::errc() ? std::optional<double>(value) : std::nullopt;
}

}  // namespace

void WrlScanner::skip_blanks() {
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (c == '#') {
      while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
      continue;
    }
    if (!is_blank(c)) return;
    ++at_;
    const bool pair = c == '\r' && at_ < text_.size() && text_[at_] == '\n';
    if (c == '\n' || (c == '\r' && !pair)) {
      ++line_;
      line_begin_ = at_;
    }
  }
}

void WrlScanner::read_string() {
  kind_ = WrlToken::string;
  const std::size_t first = ++at_;
  std::int64_t lines = 0;
  std::size_t line_begin = line_begin_;
  while (at_ < text_.size() && text_[at_] != '"') {
    if (text_[at_] == '\n') {
      ++lines;
      line_begin = at_ + 1;
    }
    at_ += text_[at_] == '\\' ? 2 : 1;
  }
  at_ = std::min(at_, text_.size());
  token_ = text_.substr(first, at_ - first);
  if (at_ < text_.size()) ++at_;
  // where() is that of the begin until the next token is read.
  line_ += lines;
  if (lines > 0) line_begin_ = begin_ = line_begin;
}

void WrlScanner::read() {
  skip_blanks();
  begin_ = at_;
  if (at_ == text_.size()) {
    kind_ = WrlToken::end;
    token_ = {};
    return;
  }
  const char c = text_[at_];
  if (c == '"') return read_string();
  constexpr std::string_view kBrackets = "{}[]";
  if (const std::size_t k = kBrackets.find(c); k != std::string_view::npos) {
    constexpr WrlToken kKinds[] = {WrlToken::open, WrlToken::close, WrlToken::open_list,
                                   WrlToken::close_list};
    kind_ = kKinds[k];
    token_ = text_.substr(at_++, 1);
    return;
  }
  while (at_ < text_.size() && !ends_word(text_[at_])) ++at_;
  token_ = text_.substr(begin_, at_ - begin_);
  const std::optional<double> value = number_of(token_);
  kind_ = value ? WrlToken::number : WrlToken::word;
  number_ = value.value_or(0);
}

}  // namespace animeme::head::detail
