#include "tools/view/gltf/detail/json_text.h"

#include <algorithm>

#include "tools/formats/common/json.h"

namespace animeme::gltf {
namespace {

bool is_json_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// Keys may be written with escapes.
bool is_key(std::string_view token, std::string_view key) {
  const std::string_view inner = token.substr(1, token.size() - 2);
  if (inner.find('\\') == std::string_view::npos) return inner == key;
  const auto plain = tools::Json::parse(token);
  return plain && *plain == key;
}

}  // namespace

JsonText::JsonText(std::string_view text) : text_(text) {
  const std::size_t begin = std::min(text.find('{'), text.size());
  root_ = {begin, skip_value(begin)};
}

std::size_t JsonText::skip_space(std::size_t at) const {
  while (at < text_.size() && is_json_space(text_[at])) ++at;
  return at;
}

std::size_t JsonText::skip_string(std::size_t at) const {
  for (++at; at < text_.size() && text_[at] != '"'; ++at) {
    if (text_[at] == '\\') ++at;
  }
  return std::min(at + 1, text_.size());
}

// Depth is counted: nothing here recurs.
std::size_t JsonText::skip_value(std::size_t at) const {
  std::size_t depth = 0;
  while (at < text_.size()) {
    const char c = text_[at];
    if (c == '"') {
      at = skip_string(at);
    } else if (c == '{' || c == '[') {
      ++depth;
      ++at;
    } else if (c == '}' || c == ']') {
      if (depth == 0) return at;
      --depth;
      ++at;
    } else if (depth == 0 && (c == ',' || is_json_space(c))) {
      return at;
    } else {
      ++at;
      // Numbers and words end where something else begins.
      if (depth == 0) continue;
    }
    if (depth == 0) return at;
  }
  return text_.size();
}

std::optional<JsonText::Member> JsonText::find(Span object, std::string_view key) const {
  std::optional<Member> found;
  if (object.begin >= object.end || text_[object.begin] != '{') return found;
  std::size_t at = skip_space(object.begin + 1);
  while (at < object.end && text_[at] == '"') {
    const std::size_t key_end = skip_string(at);
    const std::string_view token = text_.substr(at, key_end - at);
    const std::size_t begin = skip_space(skip_space(key_end) + 1);  // beyond the colon
    const std::size_t end = skip_value(begin);
    if (is_key(token, key)) found = Member{{at, end}, {begin, end}};
    at = skip_space(end);
    if (at < object.end && text_[at] == ',') at = skip_space(at + 1);
  }
  return found;
}

std::optional<JsonText::Span> JsonText::member(Span object, std::string_view key) const {
  const std::optional<Member> found = find(object, key);
  return found ? std::optional(found->value) : std::nullopt;
}

std::optional<JsonText::Span> JsonText::member_and_key(Span object, std::string_view key) const {
  const std::optional<Member> found = find(object, key);
  return found ? std::optional(found->whole) : std::nullopt;
}

std::vector<JsonText::Span> JsonText::entries(Span array) const {
  std::vector<Span> all;
  if (array.begin >= array.end || text_[array.begin] != '[') return all;
  std::size_t at = skip_space(array.begin + 1);
  while (at < array.end && text_[at] != ']') {
    const std::size_t end = skip_value(at);
    all.push_back({at, end});
    at = skip_space(end);
    if (at >= array.end || text_[at] != ',') break;
    at = skip_space(at + 1);
  }
  return all;
}

void JsonText::replace(Span value, std::string text) {
  changes_.push_back({value, std::move(text)});
}

void JsonText::append(Span list, const std::string& text) {
  std::size_t end = list.end - 1;  // of the last entry
  while (end > list.begin + 1 && is_json_space(text_[end - 1])) --end;
  const bool empty = end == list.begin + 1;
  // What was appended before makes it longer.
  const bool more = std::any_of(changes_.begin(), changes_.end(), [&](const Change& change) {
    return change.at.begin == end && change.at.end == end;
  });
  changes_.push_back({{end, end}, (empty && !more ? "" : ",") + text});
}

std::string JsonText::changed() const {
  std::vector<const Change*> order;
  for (const Change& change : changes_) order.push_back(&change);
  std::stable_sort(order.begin(), order.end(),
                   [](const Change* a, const Change* b) { return a->at.begin < b->at.begin; });
  std::string out;
  std::size_t done = 0;
  for (const Change* change : order) {
    out += text_.substr(done, change->at.begin - done);
    out += change->text;
    done = change->at.end;
  }
  out += text_.substr(done);
  return out;
}

std::string quoted_json(std::string_view text) { return tools::Json(text).dump(); }

}  // namespace animeme::gltf
