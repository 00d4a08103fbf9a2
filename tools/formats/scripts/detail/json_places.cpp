// Where in a text the values of a JSON stand: the parser does not tell.
#include <algorithm>
#include <unordered_map>

#include "tools/formats/scripts/detail/json_script.h"

namespace animeme::scripts {

namespace {

struct Place {
  std::int64_t line = 0, column = 0;
};

using Places = std::unordered_map<std::string, Place>;

// Walks over a text that the parser has accepted, with a stack of its own, and notes the places of
// the paths that are wanted.
class JsonWalk {
 public:
  JsonWalk(std::string_view text, std::string root, Places& wanted)
      : text_(text), path_(std::move(root)), wanted_(wanted) {}

  // From `at`, where a value begins, to its end. `line` and `begin` are those of `at`.
  void walk(std::size_t at, std::int64_t line, std::size_t begin) {
    at_ = at;
    line_ = line;
    line_begin_ = begin;
    while (skip_blanks(), at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '}' || c == ']') {
        leave();
      } else if (c == ',') {
        ++at_;
        next_entry();
        continue;
      } else {
        value();
      }
      if (open_.empty()) return;
    }
  }

 private:
  struct Open {
    bool array;
    std::size_t index;        // of an array
    std::size_t path_length;  // before the entry
  };

  void value() {
    const auto found = wanted_.find(path_);
    if (found != wanted_.end() && found->second.line == 0) {
      found->second = {line_, std::int64_t(at_ - line_begin_) + 1};
    }
    const char c = text_[at_];
    if (c == '{' || c == '[') {
      ++at_;
      open_.push_back({c == '[', 0, path_.size()});
      skip_blanks();
      if (at_ < text_.size() && text_[at_] != '}' && text_[at_] != ']') enter();
    } else if (c == '"') {
      string();
    } else {
      at_ = std::min(text_.find_first_of(",]} \t\r\n", at_), text_.size());
    }
  }

  void next_entry() {
    if (open_.empty()) return;
    path_.resize(open_.back().path_length);
    ++open_.back().index;
    skip_blanks();
    enter();
  }

  // Names the entry that begins here.
  void enter() {
    if (open_.back().array) {
      path_ += "/" + std::to_string(open_.back().index);
      return;
    }
    path_ += "/" + string();
    skip_blanks();
    if (at_ < text_.size() && text_[at_] == ':') ++at_;
  }

  void leave() {
    ++at_;
    if (open_.empty()) return;
    path_.resize(open_.back().path_length);
    open_.pop_back();
  }

  // Members that are wanted have plain names: what is escaped in others need not be undone.
  std::string string() {
    const std::size_t begin = ++at_;
    while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    at_ = std::min(at_, text_.size());
    std::string out(text_.substr(begin, at_ - begin));
    ++at_;
    return out;
  }

  void skip_blanks() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\n') {
        ++line_;
        line_begin_ = at_ + 1;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        return;
      }
      ++at_;
    }
  }

  std::string_view text_;
  std::string path_;
  Places& wanted_;
  std::vector<Open> open_;
  std::size_t at_ = 0, line_begin_ = 0;
  std::int64_t line_ = 1;
};

}  // namespace

void place_labels(std::string_view text, const std::vector<std::size_t>& offsets, JsonLabels& out,
                  Error* error) {
  const std::vector<std::string>& paths = out.paths;
  Places places;
  for (const std::string& path : paths) places.emplace(path, Place{});
  std::int64_t line = 1;
  std::size_t begin = 0, seen = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    for (; seen < offsets[i]; ++seen) {
      if (text[seen] != '\n') continue;
      ++line;
      begin = seen + 1;
    }
    JsonWalk(text, std::to_string(i), places).walk(offsets[i], line, begin);
  }
  const auto place_of = [&](std::int64_t number) {
    const bool known = number > 0 && number <= std::int64_t(paths.size());
    return known ? places[paths[std::size_t(number - 1)]] : Place{};
  };
  for (dam::ScriptNote& note : out.notes) note.line = place_of(note.line).line;
  for (dam::TimedLabel& label : out.labels) {
    const Place place = place_of(label.line);
    label.line = place.line;
    label.column = place.column;
  }
  if (error != nullptr) {
    const Place place = place_of(error->where.line);
    error->where.line = place.line;
    error->where.column = place.column;
  }
}

}  // namespace animeme::scripts
