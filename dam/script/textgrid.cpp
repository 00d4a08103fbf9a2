#include "dam/script/textgrid.h"

#include <algorithm>
#include <cmath>

#include "dam/script/script_finish_internal.h"
#include "dam/script/script_values_internal.h"
#include "fap/detail/real_text.h"

namespace animeme::dam {
namespace {

enum class TokenKind : std::uint8_t { number, string, flag, end };

struct Token {
  TokenKind kind = TokenKind::end;
  double number = 0;
  std::string text;
  std::int64_t line = 0, column = 0;
};

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

class Tokens {
 public:
  explicit Tokens(std::string_view text) : rest_(text), line_begin_(text.data()) {}

  Result<Token> next() {
    while (skip_space()) {
      const std::int64_t line = line_;
      const char c = rest_[0];
      if (c == '"') return string();
      if (c == '!') {
        advance(std::min(rest_.find_first_of("\r\n"), rest_.size()));
      } else if (c == '<') {
        const std::string_view flag = advance(std::min(rest_.find('>'), rest_.size() - 1) + 1);
        return Token{TokenKind::flag, 0, std::string(flag), line, 0};
      } else {
        const std::string_view word =
            advance(std::min(rest_.find_first_of(" \t\r\n"), rest_.size()));
        double number = 0;
        const auto [end, error] =
            fap::detail::read_real(word.data(), word.data() + word.size(), number);
        const bool whole = end == word.data() + word.size();
        if (error != std::errc::invalid_argument && whole && starts_number(word)) {
          if (error != std::errc() || !std::isfinite(number)) {
            return error_at_line(Code::out_of_range,
                                 in_quotes(word) + " is not a finite number of seconds", line);
          }
          return Token{TokenKind::number, number, {}, line, 0};
        }
      }
    }
    return Token{TokenKind::end, 0, {}, line_, 0};
  }

 private:
  // Praat's free-standing numbers; not "inf", "nan" or "infant", which are words.
  static bool starts_number(std::string_view word) {
    return word[0] == '-' || word[0] == '.' || (word[0] >= '0' && word[0] <= '9');
  }

  std::string_view advance(std::size_t count) {
    const std::string_view taken = rest_.substr(0, count);
    for (const char& c : taken) {
      if (c != '\n') continue;
      ++line_;
      line_begin_ = &c + 1;
    }
    rest_.remove_prefix(count);
    return taken;
  }

  bool skip_space() {
    std::size_t count = 0;
    while (count < rest_.size() && is_space(rest_[count])) ++count;
    advance(count);
    return !rest_.empty();
  }

  Result<Token> string() {
    Token token{TokenKind::string, 0, {}, line_, rest_.data() - line_begin_ + 1};
    std::size_t at = 1;
    for (;; ++at) {
      if (at >= rest_.size()) {
        return error_at_line(Code::truncated,
                             "the string that begins here has no closing quote; a quote inside "
                             "a string is written twice",
                             token.line);
      }
      const bool quote = rest_[at] == '"';
      if (quote && !(at + 1 < rest_.size() && rest_[at + 1] == '"')) break;
      if (quote) ++at;
      token.text += rest_[at];
    }
    advance(at + 1);
    return token;
  }

  std::string_view rest_;
  const char* line_begin_;
  std::int64_t line_ = 1;
};

// Takes the expected tokens in turn; the first failure sticks.
class Parser {
 public:
  explicit Parser(std::string_view text) : tokens_(text) {}

  Token take(TokenKind kind, std::string_view what) {
    if (failed_) return {};
    auto token = tokens_.next();
    if (!token) {
      fail(token.error());
    } else if (token->kind == TokenKind::end) {
      fail(error_at_line(
          Code::truncated,
          "the TextGrid ends where " + std::string(what) + " should follow; save it again",
          token->line));
    } else if (token->kind != kind) {
      fail(error_at_line(Code::syntax,
                         std::string(what) + " expected; is this a TextGrid of Praat?",
                         token->line));
    }
    return failed_ ? Token{} : *std::move(token);
  }

  double number(std::string_view what) { return take(TokenKind::number, what).number; }

  /// What comes next; the end where nothing can be read.
  TokenKind next_kind() const {
    Tokens ahead = tokens_;
    const auto token = failed_ ? Token{} : ahead.next();
    return token ? token->kind : TokenKind::number;  // whoever takes it gets the error
  }

  void fail(Error error) {
    if (!failed_) error_ = std::move(error);
    failed_ = true;
  }
  bool failed() const { return failed_; }
  const Error& error() const { return error_; }

 private:
  Tokens tokens_;
  bool failed_ = false;
  Error error_;
};

// Counts are only claims: a file of three lines can claim a billion, and who edits a file by hand
// forgets them. An interval begins with a number, a tier with a string.
bool is_count(double value) { return value >= 0 && value <= 1e9 && value == std::floor(value); }

void compare_counts(const std::string& what, double claimed, std::size_t held, std::int64_t line,
                    std::vector<ScriptNote>& notes) {
  if (claimed == double(held)) return;
  add_note(notes, ScriptNote::Kind::counts,
           what + " says that it has " + format_seconds(claimed) + " entries and holds " +
               std::to_string(held) + "; these are read",
           line);
}

TextGridTier read_tier(Parser& parser, std::vector<ScriptNote>& notes) {
  TextGridTier tier;
  const Token type = parser.take(TokenKind::string, "the type of a tier (\"IntervalTier\")");
  tier.points = type.text == "TextTier";
  if (!parser.failed() && !tier.points && type.text != "IntervalTier") {
    parser.fail(error_at_line(
        Code::syntax,
        "a tier is an \"IntervalTier\" or a \"TextTier\", not " + in_quotes(type.text), type.line));
  }
  tier.name = parser.take(TokenKind::string, "the name of a tier").text;
  parser.number("the start of a tier");
  parser.number("the end of a tier");
  const Token counted = parser.take(TokenKind::number, "the number of intervals");
  const double count = counted.number;
  if (!is_count(count)) {
    parser.fail(make_error(Code::syntax, "the number of intervals of tier " + in_quotes(tier.name) +
                                             " is not a whole number"));
  }
  while (!parser.failed() && parser.next_kind() == TokenKind::number) {
    TextGridItem item;
    item.start = parser.number("a time");
    item.end = tier.points ? item.start : parser.number("the end of an interval");
    Token text = parser.take(TokenKind::string, "the text of an interval");
    item.text = std::move(text.text);
    item.line = text.line;
    item.column = text.column;
    if (!parser.failed()) tier.items.push_back(std::move(item));
  }
  if (!parser.failed()) {
    compare_counts("tier " + in_quotes(tier.name), count, tier.items.size(), counted.line, notes);
  }
  return tier;
}

void check_header(Parser& parser) {
  const Token type = parser.take(TokenKind::string, "the file type \"ooTextFile\"");
  // Old versions wrote "ooTextFile short".
  if (!parser.failed() && !type.text.starts_with("ooTextFile")) {
    parser.fail(error_at_line(Code::syntax,
                              "file type " + in_quotes(type.text) + " instead of \"ooTextFile\"",
                              type.line));
  }
  const Token object = parser.take(TokenKind::string, "the object class \"TextGrid\"");
  if (!parser.failed() && object.text != "TextGrid") {
    parser.fail(error_at_line(Code::unsupported,
                              "this Praat file holds a " + in_quotes(object.text) +
                                  "; select the TextGrid in Praat and save that one",
                              object.line));
  }
}

std::string doubled_quotes(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out;
}

std::string format_item(const TextGridItem& item, bool point) {
  const std::string indent = "            ";
  const std::string text = " = \"" + doubled_quotes(item.text) + "\"\n";
  if (point) {
    return indent + "number = " + format_seconds(item.start) + "\n" + indent + "mark" + text;
  }
  return indent + "xmin = " + format_seconds(item.start) + "\n" + indent +
         "xmax = " + format_seconds(item.end) + "\n" + indent + "text" + text;
}

}  // namespace

Result<TextGrid> parse_textgrid(std::string_view utf8) {
  if (utf8.starts_with("ooBinaryFile")) {
    return make_error(Code::unsupported,
                      "a binary TextGrid; save it in Praat as a text file or a short text file");
  }
  Parser parser(utf8);
  check_header(parser);
  TextGrid grid;
  grid.start = parser.number("the start time");
  grid.end = parser.number("the end time");
  const Token flag = parser.take(TokenKind::flag, "<exists>");
  if (!parser.failed() && flag.text == "<absent>") return grid;
  const Token counted = parser.take(TokenKind::number, "the number of tiers");
  const double count = counted.number;
  if (!is_count(count)) parser.fail(make_error(Code::syntax, "the number of tiers is invalid"));
  const bool any = !parser.failed() && count > 0;  // a file that holds none was cut
  while (!parser.failed() &&
         ((any && grid.tiers.empty()) || parser.next_kind() != TokenKind::end)) {
    grid.tiers.push_back(read_tier(parser, grid.notes));
  }
  if (parser.failed()) return parser.error();
  compare_counts("the file", count, grid.tiers.size(), counted.line, grid.notes);
  return grid;
}

std::string format_textgrid(const TextGrid& grid) {
  const std::string times =
      "xmin = " + format_seconds(grid.start) + "\nxmax = " + format_seconds(grid.end) + "\n";
  std::string out = "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\n" + times;
  out += "tiers? <exists>\nsize = " + std::to_string(grid.tiers.size()) + "\nitem []:\n";
  for (std::size_t t = 0; t < grid.tiers.size(); ++t) {
    const TextGridTier& tier = grid.tiers[t];
    const std::string kind = tier.points ? "points" : "intervals";
    out += "    item [" + std::to_string(t + 1) + "]:\n        class = \"";
    out += tier.points ? "TextTier" : "IntervalTier";
    out += "\"\n        name = \"" + doubled_quotes(tier.name) + "\"\n        xmin = ";
    out += format_seconds(grid.start) + "\n        xmax = " + format_seconds(grid.end);
    out += "\n        " + kind + ": size = " + std::to_string(tier.items.size()) + "\n";
    for (std::size_t i = 0; i < tier.items.size(); ++i) {
      out += "        " + kind + " [" + std::to_string(i + 1) + "]:\n";
      out += format_item(tier.items[i], tier.points);
    }
  }
  return out;
}

}  // namespace animeme::dam
