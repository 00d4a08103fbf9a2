#include "tests/structure/tokens.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace animeme::test {
namespace {

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  Tokens tokens() {
    Tokens out;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (std::isspace(static_cast<unsigned char>(c))) {
        line_start_ = line_start_ || c == '\n';
        ++at_;
        continue;
      }
      if (text_.substr(at_, 2) == "//" || (c == '#' && line_start_)) {
        skip_line();
      } else if (text_.substr(at_, 2) == "/*") {
        skip_behind("*/");
      } else {
        line_start_ = false;
        out.push_back(token(c));
      }
    }
    return out;
  }

 private:
  std::string_view token(char c) {
    const std::size_t start = at_;
    if (c == '"' || c == '\'') {
      literal(c);
      return "\"";
    }
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
      const bool number = std::isdigit(static_cast<unsigned char>(c));
      while (at_ < text_.size() &&
             (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_' ||
              (number && is_one_of({&text_[at_], 1}, {"'", "."})))) {
        ++at_;
      }
      const std::string_view word = text_.substr(start, at_ - start);
      if (text_.substr(at_, 1) == "\"" && is_one_of(word, {"R", "u8R", "LR", "uR", "UR"})) {
        const std::size_t open = text_.find('(', at_);
        skip_behind(")" + std::string(text_.substr(at_ + 1, open - at_ - 1)) + "\"");
        return "\"";
      }
      return word;
    }
    at_ += is_one_of(text_.substr(at_, 2), {"::", "->"}) ? 2 : 1;
    return text_.substr(start, at_ - start);
  }

  void literal(char quote) {
    for (++at_; at_ < text_.size() && text_[at_] != quote; ++at_) at_ += text_[at_] == '\\';
    ++at_;
  }

  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') at_ += text_[at_] == '\\' ? 2 : 1;
  }

  void skip_behind(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool line_start_ = true;
};

}  // namespace

bool is_word(std::string_view token) {
  return !token.empty() && (std::isalpha(static_cast<unsigned char>(token[0])) || token[0] == '_');
}

bool is_one_of(std::string_view token, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), token) != words.end();
}

Tokens tokens_of(std::string_view text) { return Scanner(text).tokens(); }

std::size_t behind_bracket(const Tokens& tokens, std::size_t open) {
  const std::string_view opens = tokens[open];
  const std::string_view closes = opens == "("   ? ")"
                                  : opens == "{" ? "}"
                                  : opens == "[" ? "]"
                                                 : ">";
  int depth = 0;
  for (std::size_t i = open; i < tokens.size(); ++i) {
    if (opens == "<" && tokens[i] == "(") i = behind_bracket(tokens, i) - 1;
    if (i >= tokens.size()) break;
    depth += (tokens[i] == opens) - (tokens[i] == closes);
    if (depth == 0) return i + 1;
  }
  return tokens.size();
}

std::size_t behind_list(const Tokens& tokens, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < tokens.size() && !is_one_of(tokens[i], {";", "{"}); ++i) {
    if (tokens[i] == "(") i = behind_bracket(tokens, i) - 1;
    if (i >= tokens.size()) break;
    depth += (tokens[i] == "<") - (tokens[i] == ">");
    if (depth == 0) return i + 1;
  }
  return open;
}

}  // namespace animeme::test
