// Walks over a text token by token and line by line, and knows where it is. Internal.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace animeme::fap::detail {

/// A place in a text that is read piece by piece: its line, and the bytes before it on that line.
struct TextPlace {
  std::int64_t line = 1;
  std::int64_t before = 0;
};

/// Tokens are separated by blanks and tabs, lines end with LF, CR LF or CR. A token that starts
/// with '#' begins a comment that runs to the end of its line. All steps are linear in the text
/// passed over; nothing is allocated.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text)
      : at_(text.data()), end_(text.data() + text.size()), line_begin_(at_) {}
  /// A piece of a text that begins at `place`. `end_seen` becomes true as soon as a step, of this
  /// scanner or of a copy, depends on the piece ending where it does.
  TextScanner(std::string_view piece, TextPlace place, bool& end_seen) : TextScanner(piece) {
    line_ = place.line;
    before_ = place.before;
    end_seen_ = &end_seen;
  }

  /// Goes to the next token, over blanks, comments and line ends. False: the text is over.
  bool to_content();

  /// Reads the next token of this line. Empty: the line (or the text) has no more.
  std::string_view token();

  /// Number of tokens that token() would still give on this line, at most `limit`.
  int count_rest(int limit) const {
    TextScanner ahead = *this;
    int count = 0;
    while (count < limit && !ahead.token().empty()) ++count;
    return count;
  }

  /// The text from here to the end of the line, comment included; goes to the line end.
  std::string_view rest_of_line() {
    const char* begin = at_;
    skip_line();
    return {begin, std::size_t(at_ - begin)};
  }

  std::int64_t line() const { return line_; }
  /// Column of the token read last, from 1.
  std::int64_t token_column() const { return token_begin_ - line_begin_ + before_ + 1; }
  /// Column of the next byte, from 1.
  std::int64_t column() const { return at_ - line_begin_ + before_ + 1; }
  /// Where the next piece begins if this one is read up to here.
  TextPlace place() const { return {line_, at_ - line_begin_ + before_}; }
  const char* position() const { return at_; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }

  bool at_end() const {
    if (at_ != end_) return false;
    if (end_seen_ != nullptr) *end_seen_ = true;
    return true;
  }
  void skip_blanks() {
    while (!at_end() && is_blank(*at_)) ++at_;
  }
  void skip_line() {
    while (!at_end() && !is_line_end(*at_)) ++at_;
  }
  void pass_line_end() {
    const bool carriage_return = *at_++ == '\r';
    if (carriage_return && !at_end() && *at_ == '\n') ++at_;
    line_begin_ = at_;
    before_ = 0;
    ++line_;
  }

  const char* at_;
  const char* end_;
  const char* line_begin_;
  const char* token_begin_ = line_begin_;
  std::int64_t line_ = 1;
  std::int64_t before_ = 0;   // bytes of the line before line_begin_
  bool* end_seen_ = nullptr;  // borrowed; null: nobody asks
};

/// ASCII letters in lower case, the rest as it is.
inline std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return out;
}

/// `token` in quotes for a message: unprintable bytes become '?', long ones are cut.
inline std::string in_quotes(std::string_view token) {
  constexpr std::size_t longest = 32;
  std::string text = "'";
  for (const char c : token.substr(0, longest)) text += c < ' ' || c > '~' ? '?' : c;
  return text + (token.size() > longest ? "...'" : "'");
}

/// Whether bytes are UTF-16 without a byte order mark, and then whether the high byte is the first.
/// Digits, blanks and line ends, of which every file of numbers has many, have a zero byte there,
/// always on the same side; other encodings of text have no zero bytes, and a single one is damage.
/// Checks the first 4 kB.
inline std::optional<bool> unmarked_utf16(std::string_view bytes) {
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
