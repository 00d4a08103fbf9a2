#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "fap/detail/real_text.h"
#include "fap/detail/text_scanner.h"
#include "fap/head/detail/scene.h"
#include "fap/result.h"

namespace animeme::head::detail {

namespace {

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

// Walks over a text. Blanks, line ends, commas and comments separate tokens.
class WrlScanner {
 public:
  explicit WrlScanner(std::string_view text) : text_(text) { read(); }

  WrlToken kind() const { return kind_; }
  // Of words and strings (without quotes, escapes as they are); as written for the others.
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

using fap::detail::in_quotes;

class Parser {
 public:
  explicit Parser(std::string_view text) : in_(text) {}

  Result<std::vector<SceneNodePtr>> parse() {
    std::vector<SceneNodePtr> roots;
    while (in_.kind() != WrlToken::end) {
      if (in_.kind() != WrlToken::word) return error("a node is expected here, not " + shown());
      if (is_statement()) {
        if (auto done = pass_statement(); !done) return done.error();
        continue;
      }
      auto node = parse_node(0);
      if (!node) return node.error();
      if (*node) roots.push_back(std::move(*node));
    }
    return roots;
  }

 private:
  Error error(std::string message) const { return {Code::syntax, std::move(message), in_.where()}; }
  Error ended(const std::string& within, const Position& begin) const {
    return {Code::truncated,
            "the file ends within " + within + " that begins in line " + std::to_string(begin.line),
            in_.where()};
  }
  std::string shown() const {
    return in_.kind() == WrlToken::end ? "the end of the file" : in_quotes(in_.text());
  }

  bool is_statement() const { return in_.is("PROTO") || in_.is("EXTERNPROTO") || in_.is("ROUTE"); }

  // ROUTE a.b TO c.d; PROTO name [...] {...}; EXTERNPROTO name [...] "url" or ["url" ...].
  Result<void> pass_statement() {
    const bool proto = in_.is("PROTO");
    const bool route = in_.is("ROUTE");
    in_.next();
    for (int i = 0; i < (route ? 3 : 1) && in_.kind() == WrlToken::word; ++i) in_.next();
    if (route) return {};
    if (auto done = pass_brackets(); !done) return done;
    if (proto) return pass_brackets();
    if (in_.kind() == WrlToken::open_list) return pass_brackets();
    while (in_.kind() == WrlToken::string) in_.next();
    return {};
  }

  // A pair of brackets with all that is in it.
  Result<void> pass_brackets() {
    const Position begin = in_.where();
    if (in_.kind() != WrlToken::open && in_.kind() != WrlToken::open_list) {
      return error("a bracket is expected here, not " + shown());
    }
    int depth = 0;
    do {
      if (in_.kind() == WrlToken::end) return ended("brackets", begin);
      if (in_.kind() == WrlToken::open || in_.kind() == WrlToken::open_list) ++depth;
      if (in_.kind() == WrlToken::close || in_.kind() == WrlToken::close_list) --depth;
      in_.next();
    } while (depth > 0);
    return {};
  }

  // At DEF, USE, NULL or a type. Null for NULL and for nodes that no mesh needs.
  Result<SceneNodePtr> parse_node(int depth) {
    if (depth > kDeepestNode) {
      return Error{Code::out_of_range,
                   "nodes are nested more than " + std::to_string(kDeepestNode) + " levels",
                   in_.where()};
    }
    if (in_.is("NULL")) {
      in_.next();
      return SceneNodePtr();
    }
    if (in_.is("USE")) return parse_use();
    auto node = std::make_shared<SceneNode>();
    node->where = in_.where();
    if (in_.is("DEF")) {
      in_.next();
      if (in_.kind() != WrlToken::word) return error("DEF needs a name, not " + shown());
      node->name = in_.text();
      in_.next();
    }
    if (in_.kind() != WrlToken::word) return error("a node type is expected, not " + shown());
    node->type = in_.text();
    in_.next();
    if (in_.kind() != WrlToken::open) {
      return error(node->type + " needs a '{' here, not " + shown());
    }
    if (node->type == "Script") {
      if (auto done = pass_brackets(); !done) return done.error();
      return SceneNodePtr();
    }
    in_.next();
    if (auto done = parse_fields(*node, depth); !done) return done.error();
    // Only now, so that no node can be within itself.
    if (!node->name.empty()) names_[node->name] = node;
    return node;
  }

  Result<SceneNodePtr> parse_use() {
    in_.next();
    const auto found = names_.find(in_.text());
    if (in_.kind() != WrlToken::word || found == names_.end()) {
      return error("USE needs the name of a node that is complete before, not " + shown());
    }
    in_.next();
    return found->second;
  }

  Result<void> parse_fields(SceneNode& node, int depth) {
    while (in_.kind() != WrlToken::close) {
      if (in_.kind() == WrlToken::end) return ended(node.type, node.where);
      if (in_.kind() != WrlToken::word) {
        return error("a field of " + node.type + " or '}' is expected here, not " + shown());
      }
      if (is_statement()) {
        if (auto done = pass_statement(); !done) return done;
        continue;
      }
      const std::string field(in_.text());
      in_.next();
      auto value = parse_value(node, field, depth);
      if (!value) return value.error();
      if (auto done = set_field(node, field, std::move(*value)); !done) return done;
    }
    in_.next();
    return {};
  }

  Result<SceneValue> parse_value(const SceneNode& node, const std::string& field, int depth) {
    SceneValue value;
    value.where = in_.where();
    const bool list = in_.kind() == WrlToken::open_list;
    if (list) in_.next();
    bool any = false;
    for (;; any = true) {
      if (list && in_.kind() == WrlToken::close_list) {
        in_.next();
        return value;
      }
      if (in_.kind() == WrlToken::number) {
        value.numbers.push_back(in_.number());
        in_.next();
      } else if (in_.kind() == WrlToken::string) {
        value.words.emplace_back(in_.text());
        in_.next();
      } else if (in_.kind() == WrlToken::word && (list || !any)) {
        if (auto done = parse_word(value, depth); !done) return done.error();
        if (!list) return value;
      } else if (!list && any) {
        return value;  // the next field
      } else if (in_.kind() == WrlToken::end) {
        return ended("field " + field + " of " + node.type, value.where);
      } else {
        return error("field " + field + " of " + node.type + " cannot be " + shown());
      }
    }
  }

  // A node, TRUE, FALSE, or IS of a prototype.
  Result<void> parse_word(SceneValue& value, int depth) {
    if (in_.is("TRUE") || in_.is("FALSE")) {
      value.words.emplace_back(in_.text());
      in_.next();
      return {};
    }
    if (in_.is("IS")) {
      in_.next();
      if (in_.kind() == WrlToken::word) in_.next();
      return {};
    }
    auto node = parse_node(depth + 1);
    if (!node) return node.error();
    if (*node) value.nodes.push_back(std::move(*node));
    return {};
  }

  WrlScanner in_;
  std::map<std::string, SceneNodePtr, std::less<>> names_;
};

}  // namespace

Result<std::vector<SceneNodePtr>> wrl_scene(std::string_view text,
                                            std::vector<std::string>* notes) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.starts_with("\x1f\x8b")) {
    return error_at_line(Code::unsupported, "the file is compressed; run gunzip on it first", 1, 1);
  }
  if (text.starts_with("#VRML V1") || text.starts_with("#Inventor")) {
    return error_at_line(Code::unsupported,
                         "this is VRML 1.0 or Inventor; save it as VRML 2.0 (VRML97)", 1, 1);
  }
  if (!text.starts_with("#VRML") && notes != nullptr) {
    notes->push_back("the first line is not \"#VRML V2.0 utf8\"; read as VRML97");
  }
  return Parser(text).parse();
}

}  // namespace animeme::head::detail
