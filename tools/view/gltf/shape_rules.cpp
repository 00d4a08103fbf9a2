#include "tools/view/gltf/shape_rules.h"

#include <algorithm>

#include "fap/detail/text_scanner.h"
#include "tools/formats/files/files.h"
#include "tools/view/gltf/detail/words.h"
#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace {

using fap::detail::lower_case;

constexpr std::uint64_t kMostTable = 1 << 20;  // bytes

std::string trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(kBlanks) - first + 1));
}

Result<ShapeRule> checked(std::string_view name, std::string_view meaning) {
  ShapeRule rule{trimmed(name), trimmed(meaning)};
  if (rule.name.empty() || rule.meaning.empty()) {
    return make_error(Code::syntax, "write NAME=MEANING, like Mund_auf=jawOpen");
  }
  if (rule.meaning != "-" && !meaning_of(rule.meaning)) {
    return make_error(Code::invalid_argument,
                      "\"" + rule.meaning +
                          "\" is not a known meaning; write a shape of ARKit (jawOpen, "
                          "mouthSmileLeft), a viseme (viseme_PP), or - to leave the shape at rest");
  }
  return rule;
}

}  // namespace

Result<ShapeRule> parse_shape_rule(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos) return checked({}, {});
  return checked(text.substr(0, equals), text.substr(equals + 1));
}

Result<ShapeRules> read_shape_rules(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  ShapeRules rules;
  bool first = true;
  for (std::int64_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.starts_with('#')) continue;
    // A name may contain a separator, a meaning none.
    const std::size_t cut = line.find_last_of(",;\t");
    const std::string name = cut == std::string::npos ? "" : trimmed(line.substr(0, cut));
    if (std::exchange(first, false) && lower_case(name) == "shape") continue;
    Result<ShapeRule> rule =
        cut == std::string::npos
            ? make_error(Code::syntax, "write shape,meaning, like Mund_auf,jawOpen")
            : checked(name, line.substr(cut + 1));
    if (!rule) return error_at_line(rule.error().code, rule.error().message, number);
    rules.push_back(std::move(*rule));
  }
  if (rules.empty()) {
    return make_error(Code::truncated, "there is no rule in it; write lines like Mund_auf,jawOpen");
  }
  return rules;
}

Result<ShapeRules> shape_rules_of(const std::vector<std::string>& texts, const std::string& path) {
  ShapeRules rules;
  for (const std::string& text : texts) {
    Result<ShapeRule> rule = parse_shape_rule(text);
    if (!rule) {
      return make_error(rule.error().code, "--shape-name " + text + ": " + rule.error().message);
    }
    rules.push_back(std::move(*rule));
  }
  if (path.empty()) return rules;
  const Result<std::string> text = tools::read_text_file(path, kMostTable);
  if (!text) return text.error();
  const Result<ShapeRules> more = read_shape_rules(*text);
  if (!more) return more.error().in_file(path);
  rules.insert(rules.end(), more->begin(), more->end());
  return rules;
}

const ShapeRule* find_rule(const ShapeRules& rules, std::string_view name) {
  if (rules.empty()) return nullptr;
  const std::string wanted = lower_case(trimmed(name));
  for (const ShapeRule& rule : rules) {
    if (lower_case(trimmed(rule.name)) == wanted) return &rule;
  }
  return nullptr;
}

Result<void> check_rules(const ShapeRules& rules, const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 100;
  for (const ShapeRule& rule : rules) {
    const bool found = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return find_rule({rule}, name) != nullptr;
    });
    if (found) continue;
    return make_error(Code::not_found, "no morph target is called \"" + rule.name + "\"; " +
                                           (names.empty() ? "there is none"
                                                          : "there are: " + list_of(names, kMost)));
  }
  return {};
}

}  // namespace animeme::gltf
