#include "tools/formats/scripts/detail/json_script.h"

#include <algorithm>
#include <cmath>

#include "dam/script/marks.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/script_values_internal.h"
#include "dam/script/table_text_internal.h"

namespace animeme::scripts {

namespace {

constexpr int kDeepest = 12;  // an event in a list in a message in a stream is six deep

// Programs in C# write AudioOffset, in JavaScript audioOffset, in Python audio_offset.
bool same_name(std::string_view key, std::string_view name) {
  std::size_t at = 0;
  for (const char c : key) {
    if (c == '_') continue;
    const char lower = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    if (at >= name.size() || lower != name[at]) return false;
    ++at;
  }
  return at == name.size();
}

void find_in(const Node& node, const std::function<bool(const Node&)>& wanted, int depth,
             std::vector<Node>& found) {
  if (depth > kDeepest) return;
  if (node.is_object()) {
    if (wanted(node)) {
      found.push_back(node);
      return;
    }
    for (const auto& [key, value] : node.value->items()) {
      if (value.is_structured()) find_in({&value, node.path + "/" + key}, wanted, depth + 1, found);
    }
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      if (!(*node.value)[i].is_structured()) return;  // a list of numbers
      find_in(node.at(i), wanted, depth + 1, found);
    }
  }
}

}  // namespace

Node Node::member(std::initializer_list<std::string_view> names) const {
  if (!is_object()) return {};
  for (const std::string_view name : names) {
    for (const auto& [key, member] : value->items()) {
      if (same_name(key, name)) return {&member, path + "/" + key};
    }
  }
  return {};
}

Node Node::at(std::size_t index) const {
  if (index >= size()) return {};
  return {&(*value)[index], path + "/" + std::to_string(index)};
}

std::optional<double> Node::number() const {
  if (!exists()) return std::nullopt;
  std::optional<double> number;
  if (value->is_number()) number = value->get<double>();
  if (value->is_string()) number = dam::parse_number(value->text());
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<std::string> Node::text() const {
  if (!exists() || !value->is_string()) return std::nullopt;
  return std::string(dam::trimmed(value->text()));
}

dam::TimedLabel& JsonLabels::add(const Node& node, double start, double end, std::string label,
                                 bool is_word) {
  paths.push_back(node.path);
  return labels.emplace_back(
      dam::TimedLabel{start, end, std::move(label), {}, std::int64_t(paths.size()), 0, is_word});
}

Error JsonLabels::error(Code code, std::string message, const Node& node) {
  paths.push_back(node.path);
  return error_at_line(code, std::move(message), std::int64_t(paths.size()));
}

std::vector<Node> find_objects(const std::vector<Node>& roots,
                               const std::function<bool(const Node&)>& wanted) {
  std::vector<Node> found;
  for (const Node& root : roots) find_in(root, wanted, 0, found);
  return found;
}

Result<std::string> viseme_label(JsonLabels& out, const Node& node, dam::VisemeSet set,
                                 const std::string& name) {
  const auto label = dam::phone_of_viseme(set, name);
  if (label) return std::string(*label);
  if (dam::is_mark(name)) return name;
  return out.error(Code::not_found, "unknown viseme \"" + name.substr(0, 40) + "\"", node);
}

bool is_spoken(char32_t code) {
  if (code < 0x80) {
    return (code >= U'0' && code <= U'9') || ((code | 0x20) >= U'a' && (code | 0x20) <= U'z');
  }
  return code >= 0xC0 && !(code >= 0x2000 && code <= 0x206F) && !(code >= 0x3000 && code <= 0x3003);
}

static bool is_unspoken(const dam::TimedLabel& label) {
  if (!label.is_word) return false;
  for (std::string_view rest = label.label; !rest.empty();) {
    if (is_spoken(dam::take_code_point(rest))) return false;
  }
  return true;
}

void drop_unspoken(std::vector<dam::TimedLabel>& labels) { std::erase_if(labels, is_unspoken); }

namespace {

constexpr double kLeastOfWord = 0.06;   // seconds; in less nothing can be said
constexpr double kUsualLetter = 0.075;  // seconds of a calm speaker
constexpr double kDigitLetters = 4;     // "7": seven
constexpr double kSlowest = 1.5;        // times the usual length fills a gap

double usual_length(std::string_view word) {
  double letters = 0;
  while (!word.empty()) {
    const char32_t code = dam::take_code_point(word);
    if (is_spoken(code)) letters += code >= U'0' && code <= U'9' ? kDigitLetters : 1;
  }
  return std::max(2.0, letters) * kUsualLetter;
}

}  // namespace

void give_times(JsonLabels& json, std::vector<Border> borders) {
  std::vector<dam::TimedLabel>& words = json.labels;
  if (borders.size() != words.size()) borders.assign(words.size(), {});
  std::size_t spoken = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (is_unspoken(words[i])) continue;
    borders[spoken] = borders[i];
    if (spoken != i) words[spoken] = std::move(words[i]);
    ++spoken;
  }
  words.resize(spoken);
  const auto timed = [](const dam::TimedLabel& word) { return word.end > word.start; };
  std::vector<dam::TimedLabel> out;
  std::string waiting;  // words before the first that has a time
  for (std::size_t i = 0; i < words.size();) {
    if (timed(words[i])) {
      out.push_back(std::move(words[i++]));
      if (!waiting.empty()) out.back().label = waiting + " " + out.back().label;
      waiting.clear();
      continue;
    }
    std::size_t until = i;
    double usual = 0;
    const Border border = borders[i];
    const auto same = [&](std::size_t k) {
      return borders[k].start == border.start && borders[k].end == border.end;
    };
    while (until < words.size() && !timed(words[until]) && same(until)) {
      usual += usual_length(words[until++].label);
    }
    const bool bordered = border.end > border.start && border.start >= 0;
    double from = out.empty() ? 0 : out.back().end;
    double to = from;
    if (bordered) from = std::max(from, border.start);
    if (until < words.size() && timed(words[until])) to = words[until].start;
    if (bordered && (to <= from || border.end < to)) to = std::max(from, border.end);
    // A pause is left where there is time for it: behind the words, or in front of the first one.
    const bool room = to - from >= kLeastOfWord * double(until - i);
    const bool begins = out.empty() && !bordered;
    if (to - from > kSlowest * usual) {
      if (begins) {
        from = to - usual;
      } else {
        to = from + usual;
      }
    }
    double start = from;
    for (std::size_t k = i; k < until; ++k) {
      const double share = usual_length(words[k].label) / usual;
      dam::add_note(
          json.notes, dam::ScriptNote::Kind::given_times,
          dam::in_quotes(words[k].label) + " has no times; it is said between its neighbours",
          words[k].line);
      if (room) {
        words[k].start = start;
        words[k].end = start + share * (to - from);
        start = words[k].end;
        out.push_back(std::move(words[k]));
      } else if (!out.empty()) {
        out.back().label += " " + words[k].label;
      } else {
        waiting += (waiting.empty() ? "" : " ") + words[k].label;
      }
    }
    i = until;
  }
  words = std::move(out);
}

}  // namespace animeme::scripts
