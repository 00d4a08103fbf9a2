// Bytes of a text file to UTF-8 and to lines. Inside of the script readers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/detail/text_scanner.h"

namespace animeme::dam {

/// UTF-8 without byte order mark. Input: UTF-8 or UTF-16 of either byte order, both with or without
/// mark; a text that is none of these is Latin-1. What is no UTF-16 becomes U+FFFD.
std::string to_utf8(std::string_view bytes);

/// Appends one code point as UTF-8.
void append_utf8(std::string& out, char32_t code);

/// Takes one code point off the front of `text`; U+FFFD for an invalid byte. `text` must not be
/// empty.
char32_t take_code_point(std::string_view& text);

struct Line {
  std::string_view text;    ///< without the line end
  std::int64_t number = 0;  ///< from 1
};

/// Takes lines off a text one by one; LF, CR LF and CR all end a line.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}
  /// False at the end.
  bool next(Line& line);

 private:
  std::string_view rest_;
  std::int64_t number_ = 0;
};

/// Without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);

using fap::detail::lower_case;

}  // namespace animeme::dam
