#include "tests/structure/definitions.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "tests/structure/tokens.h"

namespace animeme::test {
namespace {

// The type of a parameter as text without its name, default and namespaces.
std::string type_of(Tokens parameter) {
  const auto equals = std::find(parameter.begin(), parameter.end(), "=");
  parameter.erase(equals, parameter.end());
  const auto builtin = {"int",  "char",   "bool",  "short", "long",     "double",
                        "auto", "signed", "float", "const", "unsigned", "void"};
  std::string out;
  for (std::size_t i = 0; i < parameter.size(); ++i) {
    const bool last_word = i + 1 == parameter.size() || parameter[i + 1] == "[";
    const bool name = i > 0 && last_word && is_word(parameter[i]) && parameter[i - 1] != "::" &&
                      std::find(builtin.begin(), builtin.end(), parameter[i]) == builtin.end() &&
                      parameter[i - 1] != "const" && parameter[i - 1] != "struct";
    const bool qualifier = i + 1 < parameter.size() && parameter[i + 1] == "::";
    if (name || qualifier || parameter[i] == "::") continue;
    if (!out.empty() && is_word(parameter[i]) &&
        std::isalnum(static_cast<unsigned char>(out.back()))) {
      out += ' ';
    }
    out += parameter[i];
  }
  return out;
}

// "(int,const Frame&)" of the list at tokens[open].
std::string parameters_at(const Tokens& tokens, std::size_t open) {
  const std::size_t end = behind_bracket(tokens, open) - 1;
  std::string out = "(";
  Tokens parameter;
  for (std::size_t i = open + 1, depth = 0; i <= end && i < tokens.size(); ++i) {
    if (is_one_of(tokens[i], {"(", "<", "{", "["})) ++depth;
    if (i == end || (depth == 0 && tokens[i] == ",")) {
      if (!parameter.empty()) out += (out.size() > 1 ? "," : "") + type_of(parameter);
      parameter.clear();
      continue;
    }
    if (is_one_of(tokens[i], {")", ">", "}", "]"})) --depth;
    parameter.push_back(tokens[i]);
  }
  return out + ")";
}

class Reader {
 public:
  explicit Reader(std::string_view text) : tokens_(tokens_of(text)) {}

  std::vector<std::string> definitions() {
    while (at_ < tokens_.size()) {
      if (tokens_[at_] == "}") {
        if (scopes_.empty()) return unclear();
        scopes_.pop_back();
        ++at_;
      } else if (!statement()) {
        return unclear();
      }
    }
    return scopes_.empty() ? found_ : unclear();
  }

 private:
  std::vector<std::string> unclear() {
    found_.push_back("?");
    return found_;
  }

  void note(std::string_view name) {
    std::string full;
    for (const auto& scope : scopes_) {
      if (!scope) return;  // unnamed
      if (!scope->empty()) full += *scope + "::";
    }
    found_.push_back(full + std::string(name));
  }

  // A namespace's head, or a declaration with all of its bodies.
  bool statement() {
    const std::size_t start = at_;
    std::size_t name = start + (tokens_[start] == "inline");
    if (name < tokens_.size() && tokens_[name] == "namespace") return open_namespace(name + 1);
    if (tokens_[start] == "extern" && start + 2 < tokens_.size() && tokens_[start + 1] == "\"" &&
        tokens_[start + 2] == "{") {
      scopes_.push_back("");
      at_ = start + 3;
      return true;
    }
    return declaration();
  }

  bool open_namespace(std::size_t at) {
    std::string name;
    while (at < tokens_.size() && !is_one_of(tokens_[at], {"{", "=", ";"})) name += tokens_[at++];
    if (at >= tokens_.size()) return false;
    if (tokens_[at] != "{") {  // an alias
      while (at < tokens_.size() && tokens_[at] != ";") ++at;
    } else {
      scopes_.push_back(name.empty() ? std::nullopt : std::optional<std::string>(name));
    }
    at_ = at + 1;
    return true;
  }

  bool declaration() {
    Tokens head;  // without templates' heads, attributes and bodies
    bool assigned = false, parameters = false, initialisers = false;
    while (at_ < tokens_.size()) {
      const std::string_view token = tokens_[at_];
      if (token == ";") {
        ++at_;
        variable(head);
        return true;
      }
      if (token == "{") {
        const bool type = !parameters && !assigned && type_name(head).has_value();
        const bool member =
            initialisers && !head.empty() && (is_word(head.back()) || head.back() == ">");
        at_ = behind_bracket(tokens_, at_);
        if (type) {
          note(*type_name(head));
          while (at_ < tokens_.size() && tokens_[at_] != ";") skip_one();
        } else if (parameters && !assigned && !member) {
          function(head);
          if (at_ < tokens_.size() && tokens_[at_] == ";") ++at_;
          return true;
        }
        head.push_back("}");
        continue;
      }
      if (token == "template" || token == "requires") {
        ++at_;
        if (at_ < tokens_.size() && tokens_[at_] == "<") at_ = behind_bracket(tokens_, at_);
        continue;
      }
      if (token == "[" && at_ + 1 < tokens_.size() && tokens_[at_ + 1] == "[") {
        at_ = behind_bracket(tokens_, at_);
        continue;
      }
      if (token == "=" && !parameters && (head.empty() || head.back() != "operator"))
        assigned = true;
      if (token == "=" && parameters) assigned = true;  // = default, = 0
      if (token == ":" && parameters) initialisers = true;
      std::size_t end = at_ + 1;
      if (token == "(") {
        end = behind_bracket(tokens_, at_);
        const bool call_operator = !head.empty() && head.back() == "operator";
        parameters = parameters || (!assigned && !call_operator);
      } else if (token == "<" && !head.empty() && head.back() != "operator") {
        end = behind_list(tokens_, at_);
        if (end == at_) end = at_ + 1;
      }
      for (; at_ < end && at_ < tokens_.size(); ++at_) head.push_back(tokens_[at_]);
    }
    return false;
  }

  void skip_one() {
    at_ = is_one_of(tokens_[at_], {"{", "("}) ? behind_bracket(tokens_, at_) : at_ + 1;
  }

  // "Frame", "Box<int>" of "struct alignas(8) Frame : Base".
  std::optional<std::string> type_name(const Tokens& head) {
    std::size_t i = 0;
    while (i < head.size() &&
           is_one_of(head[i], {"typedef", "inline", "static", "constexpr", "const"}))
      ++i;
    if (i >= head.size() || !is_one_of(head[i], {"struct", "class", "enum", "union"})) return {};
    for (++i; i < head.size() && is_one_of(head[i], {"class", "struct", "alignas", "("}); ++i) {
      if (head[i] == "(") i = behind_bracket(head, i) - 1;
    }
    std::string name;
    int depth = 0;
    for (; i < head.size() && (depth > 0 || !is_one_of(head[i], {":", "final"})); ++i) {
      depth += (head[i] == "<") - (head[i] == ">");
      name += head[i];
    }
    if (name.empty()) return {};
    return name;
  }

  void function(const Tokens& head) {
    std::size_t open = 0;
    bool own = false;
    while (open < head.size() && head[open] != "(") {
      own = own || is_one_of(head[open], {"static", "friend"});
      if (head[open] == "operator") {
        open += 1 + (open + 1 < head.size() && head[open + 1] == "(" ? 2 : 1);
        while (open < head.size() && head[open] != "(") ++open;
        break;
      }
      const std::size_t list = head[open] == "<" ? behind_list(head, open) : open;
      open = list == open ? open + 1 : list;
    }
    if (own || open == 0 || open >= head.size()) return;
    std::size_t first = open - 1;
    for (std::size_t i = 0; i < open; ++i) {
      if (head[i] == "operator") first = i;
    }
    if (head[open - 1] == ">") return;                                  // a specialisation
    if (first >= 1 && is_one_of(head[first - 1], {"::", "~"})) return;  // a member
    std::string name;
    for (std::size_t i = first; i < open; ++i) name += head[i];
    if (name == "main") return;
    note(name + parameters_at(head, open));
  }

  void variable(const Tokens& head) {
    if (std::find(head.begin(), head.end(), "inline") == head.end()) return;
    auto end = std::find_if(head.begin(), head.end(), [](std::string_view t) {
      return is_one_of(t, {"=", "[", "("});
    });
    if (end == head.begin() || (end != head.end() && *end == "(")) return;
    if (is_word(*(end - 1))) note(*(end - 1));
  }

  Tokens tokens_;
  std::size_t at_ = 0;
  std::vector<std::optional<std::string>> scopes_;
  std::vector<std::string> found_;
};

// What a file becomes part of: "" is every program.
std::string program_of(std::string_view path) {
  if (!path.starts_with("tests/") || path.starts_with("tests/support/") || path.ends_with(".h")) {
    return {};
  }
  if (path.starts_with("tests/fuzz/") || path.starts_with("tests/bench/") ||
      path.starts_with("tests/release/package/")) {
    return std::string(path);
  }
  return std::string(path.substr(0, path.find('/', 6)));
}

}  // namespace

std::vector<std::string> definitions_in(std::string_view text) {
  return Reader(text).definitions();
}

std::vector<std::string> double_definitions(
    const std::vector<std::pair<std::string, std::string>>& files) {
  std::map<std::string, std::vector<std::string>> where;
  std::vector<std::string> result;
  for (const auto& [path, text] : files) {
    // In place of another file, never beside it.
    if (path.ends_with("_absent.cpp") || path.ends_with("_late.cpp")) continue;
    const std::vector<std::string> names = definitions_in(text);
    for (const std::string& name : std::set<std::string>(names.begin(), names.end())) {
      if (name == "?") {
        result.push_back(path + ": the test cannot read this file to its end");
        continue;
      }
      const std::string program = program_of(path);
      for (const std::string& other : where[name]) {
        const std::string others = program_of(other);
        if (program.empty() || others.empty() || program == others) {
          result.push_back(name + ": " + other + ", " + path);
        }
      }
      where[name].push_back(path);
    }
  }
  return result;
}

}  // namespace animeme::test
