// Tokens of VRML97.
#pragma once

#include <optional>
#include <string_view>

#include "fap/result.h"

namespace animeme::head::detail {

enum class WrlToken : std::uint8_t {
  end,
  open,
  close,
  open_list,
  close_list,
  number,
  word,
  string
};

/// Walks over a text. Blanks, line ends, commas and comments separate tokens.
class WrlScanner {
 public:
  explicit WrlScanner(std::string_view text) : text_(text) { read(); }

  WrlToken kind() const { return kind_; }
  /// Of words and strings (without quotes, escapes as they are); as written for the others.
  std::string_view text() const { return token_; }
  double number() const { return number_; }
  bool is(std::string_view word) const { return kind_ == WrlToken::word && token_ == word; }
  Position where() const { return {{}, line_, std::int64_t(begin_ - line_begin_) + 1, -1}; }
  void next() { read(); }

 private:
  void read();
  void skip_blanks();
  void read_string();

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t begin_ = 0;
  std::size_t line_begin_ = 0;
  std::int64_t line_ = 1;
  WrlToken kind_ = WrlToken::end;
  std::string_view token_;
  double number_ = 0;
};

}  // namespace animeme::head::detail
