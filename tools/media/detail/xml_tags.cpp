#include "tools/media/detail/xml_tags.h"

#include <algorithm>

namespace animeme::media {
namespace {

constexpr std::size_t kMostTags = 1'000'000;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool ends_name(char c) { return is_space(c) || c == '/' || c == '>' || c == '=' || c == '<'; }

class TagReader {
 public:
  explicit TagReader(std::string_view xml) : xml_(xml) {}

  Result<std::vector<XmlTag>> read();

 private:
  // Counts on from where it was asked last: the position only grows.
  std::int64_t line() const {
    const std::size_t end = std::min(at_, xml_.size());
    lines_ += std::count(xml_.begin() + std::ptrdiff_t(counted_),
                         xml_.begin() + std::ptrdiff_t(end), '\n');
    counted_ = end;
    return lines_;
  }
  Error wrong(Code code, std::string what) const {
    return error_at_line(code, std::move(what), line());
  }
  bool at_end() const { return at_ >= xml_.size(); }
  bool skip(std::string_view text) {
    if (xml_.substr(std::min(at_, xml_.size()), text.size()) != text) return false;
    at_ += text.size();
    return true;
  }
  void skip_space() {
    while (!at_end() && is_space(xml_[at_])) ++at_;
  }
  bool skip_to(std::string_view end) {
    const std::size_t found = xml_.find(end, at_);
    at_ = found == std::string_view::npos ? xml_.size() : found + end.size();
    return found != std::string_view::npos;
  }
  std::string name();
  Result<std::string> unescape(std::string_view text) const;
  Result<XmlTag> tag();
  Result<void> attributes(XmlTag& tag);

  std::string_view xml_;
  std::size_t at_ = 0;
  mutable std::size_t counted_ = 0;
  mutable std::int64_t lines_ = 1;
};

std::string TagReader::name() {
  const std::size_t begin = at_;
  while (!at_end() && !ends_name(xml_[at_])) ++at_;
  const std::string_view whole = xml_.substr(begin, at_ - begin);
  const std::size_t colon = whole.rfind(':');
  return std::string(colon == std::string_view::npos ? whole : whole.substr(colon + 1));
}

Result<std::string> TagReader::unescape(std::string_view text) const {
  std::string out;
  constexpr std::pair<std::string_view, char> kEntities[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  while (!text.empty()) {
    const auto* entity =
        std::find_if(std::begin(kEntities), std::end(kEntities),
                     [&](const auto& candidate) { return text.starts_with(candidate.first); });
    if (entity != std::end(kEntities)) {
      out += entity->second;
      text.remove_prefix(entity->first.size());
      continue;
    }
    if (text.front() == '&') return wrong(Code::unsupported, "this entity is not known");
    out += text.front();
    text.remove_prefix(1);
  }
  return out;
}

Result<void> TagReader::attributes(XmlTag& tag) {
  for (;;) {
    skip_space();
    if (at_end()) return wrong(Code::truncated, "the document ends within a tag");
    if (skip("/>")) {
      tag.ends = true;
      return {};
    }
    if (skip(">")) return {};
    const std::string key = name();
    skip_space();
    if (key.empty() || !skip("=")) return wrong(Code::syntax, "an attribute has no value");
    skip_space();
    if (at_end()) return wrong(Code::truncated, "the document ends within a tag");
    const char quote = xml_[at_];
    if (quote != '"' && quote != '\'') return wrong(Code::syntax, "a value stands in quotes");
    const std::size_t begin = ++at_;
    if (!skip_to({&quote, 1})) return wrong(Code::truncated, "the document ends within a value");
    Result<std::string> value = unescape(xml_.substr(begin, at_ - 1 - begin));
    if (!value) return value.error();
    tag.attributes.emplace_back(key, std::move(*value));
  }
}

Result<XmlTag> TagReader::tag() {
  XmlTag tag;
  tag.line = line();
  tag.begins = !skip("/");
  tag.ends = !tag.begins;
  tag.name = name();
  if (tag.name.empty()) return wrong(Code::syntax, "a tag has no name");
  if (auto read = attributes(tag); !read) return read.error();
  Result<std::string> text = unescape(xml_.substr(at_, xml_.find('<', at_) - at_));
  if (!text) return text.error();
  tag.text = std::move(*text);
  return tag;
}

Result<std::vector<XmlTag>> TagReader::read() {
  std::vector<XmlTag> tags;
  while (skip_to("<")) {
    if (skip("?")) {
      if (!skip_to("?>")) return wrong(Code::truncated, "the document ends within a tag");
    } else if (skip("!--")) {
      if (!skip_to("-->")) return wrong(Code::truncated, "the document ends within a comment");
    } else if (skip("!")) {
      return wrong(Code::unsupported, "document types and CDATA are not read");
    } else {
      if (tags.size() >= kMostTags) return wrong(Code::out_of_range, "the document is too long");
      Result<XmlTag> read = tag();
      if (!read) return read.error();
      tags.push_back(std::move(*read));
    }
  }
  return tags;
}

}  // namespace

Result<std::vector<XmlTag>> read_tags(std::string_view xml) { return TagReader(xml).read(); }

}  // namespace animeme::media
