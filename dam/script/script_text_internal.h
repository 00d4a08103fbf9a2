// Bytes of a text file to UTF-8 and to lines. Inside of the script readers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/detail/text_scanner.h"

namespace animeme::dam {

/// Bytes that are not what the rest of their text is.
struct OddBytes {
  std::size_t count = 0;  ///< how many of them there are
  std::int64_t line = 0;  ///< of the first one, from 1; 0: there is none

  /// "3 bytes are not UTF-8; read as Windows-1252 where that gives a letter, else as U+FFFD".
  std::string describe() const;
};

/// UTF-8 without byte order mark. Input: UTF-8 or UTF-16 of either byte order, both with or without
/// mark. Text that is neither is Windows-1252 (Latin-1 with quotation marks and dashes). A text
/// with at least one character of several bytes in UTF-8 stays UTF-8: each byte that does not
/// belong there is taken for a letter or quotation mark of Windows-1252, or becomes U+FFFD, and is
/// counted in `odd`. What is no UTF-16 becomes U+FFFD.
std::string to_utf8(std::string_view bytes, OddBytes* odd = nullptr);

/// A byte as a character of Windows-1252; U+FFFD: it is none.
char32_t from_windows(char byte);

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

/// A letter of ASCII, or a byte of a longer character.
constexpr bool is_letter(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x80 || ((byte | 0x20) >= 'a' && (byte | 0x20) <= 'z');
}
/// A letter in that sense, or a digit of ASCII.
constexpr bool is_letter_or_digit(char c) { return is_letter(c) || (c >= '0' && c <= '9'); }

using fap::detail::lower_case;

/// Fewest letters to put in, leave out or change to make one word of the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace animeme::dam
