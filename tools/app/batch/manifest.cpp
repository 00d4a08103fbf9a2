#include "tools/app/batch/manifest.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tools/formats/common/json.h"
#include "tools/formats/files/files.h"
#include "tools/formats/programs/command_template.h"

namespace animeme::batch {

using tools::Json;

namespace {

constexpr std::size_t kMostLine = 1 << 20;
constexpr std::size_t kMostId = 200;  // a name of 255 bytes with an ending

// What many tables call it.
std::string column_named(std::string name) {
  if (name == "language") return "lang";
  if (name == "subtitles") return "script";
  return name == "performance" ? "over" : name;
}

Error bad(std::string message, std::int64_t line, std::int64_t column = 0) {
  return error_at_line(Code::syntax, std::move(message), line, column);
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t") == std::string_view::npos;
}

std::string_view column_of_file(const std::string& ending) {
  for (const char* one : {".wav", ".mp3", ".flac", ".ogg", ".opus", ".m4a", ".aac"}) {
    if (ending == one) return "audio";
  }
  for (const char* one : {".textgrid", ".lab", ".pho", ".vtt", ".srt", ".tsv", ".phn", ".ctm"}) {
    if (ending == one) return "script";
  }
  return ending == ".txt" || ending == ".ssml" ? "text_file" : "input";
}

// A string, a number, or for options a list of them as a command line.
Result<std::string> json_value(const Json& value, std::int64_t line, const std::string& key) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  if (value.is_null()) return std::string();
  if (!value.is_array()) return bad("\"" + key + "\" must be a text, a number or a list", line);
  std::string text;
  for (const Json& one : value) {
    const Result<std::string> word = json_value(one, line, key);
    if (!word) return word;
    text += text.empty() ? "'" : " '";
    for (const char c : *word) text += c == '\'' ? std::string("'\"'\"'") : std::string(1, c);
    text += "'";
  }
  return text;
}

// The column by which a row has a program run; empty: none.
std::string column_with_command(const Row& row) {
  for (const auto& [column, value] : row.values) {
    if (column == "tts") return column;
    if (!column.ends_with("options")) continue;
    const Result<std::vector<std::string>> words = tools::split_arguments(value);
    const auto is_tts = [](const std::string& word) { return word.starts_with("--tts"); };
    if (words && std::any_of(words->begin(), words->end(), is_tts)) return column;
  }
  return {};
}

}  // namespace

std::string_view Row::at(std::string_view column) const {
  for (const auto& [name, value] : values) {
    if (name == column) return value;
  }
  return {};
}

void Row::fill(std::string_view column, const std::string& value) {
  if (!value.empty() && at(column).empty()) values.emplace_back(column, value);
}

Form form_of(const std::string& path) {
  const std::string ending = tools::extension_of(path);
  if (ending == ".csv") return Form::csv;
  if (ending == ".jsonl" || ending == ".json" || ending == ".ndjson") return Form::json;
  return ending == ".txt" || ending == ".lst" ? Form::list : Form::table;
}

bool Manifest::is_column(std::string_view name) const {
  const std::span<const std::string_view> all =
      dialect_.columns.empty() ? std::span<const std::string_view>(kColumns) : dialect_.columns;
  return std::find(all.begin(), all.end(), name) != all.end();
}

Error Manifest::unknown_column(const std::string& name, std::int64_t line,
                               std::int64_t column) const {
  std::string all;
  for (const std::string_view one :
       dialect_.columns.empty() ? std::span<const std::string_view>(kColumns) : dialect_.columns)
    all += (all.empty() ? "" : ", ") + std::string(one);
  return bad("there is no column \"" + name + "\"; columns are " + all, line, column);
}

Result<Manifest> Manifest::open(const std::string& path, Form form,
                                std::vector<std::pair<std::string, std::string>> defaults,
                                bool allow_commands, const Dialect& dialect) {
  Manifest manifest;
  manifest.allow_commands_ = allow_commands;
  manifest.dialect_ = dialect;
  manifest.name_ = path == "-" ? "standard input" : path;
  manifest.form_ = form;
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) {
    return make_error(Code::io, "this is a folder; give a file with one row per clip")
        .in_file(path);
  }
  manifest.file_.reset(path == "-" ? std::tmpfile() : std::fopen(path.c_str(), "rbe"));
  if (!manifest.file_) {
    return make_error(errno == ENOENT ? Code::not_found : Code::io,
                      std::string("cannot read: ") + std::strerror(errno))
        .in_file(manifest.name_);
  }
  if (path == "-") {
    char block[65536];
    while (const std::size_t got = std::fread(block, 1, sizeof block, stdin)) {
      if (std::fwrite(block, 1, got, manifest.file_.get()) != got) {
        return make_error(Code::io, "no space for a copy of standard input in TMPDIR");
      }
    }
  }
  if (auto begun = manifest.begin(std::move(defaults)); !begun) return begun.error();
  return manifest;
}

Result<Manifest> Manifest::of_text(std::string_view text, Form form, bool allow_commands) {
  Manifest manifest;
  manifest.allow_commands_ = allow_commands;
  manifest.name_ = "text";
  manifest.form_ = form;
  // An empty one cannot be opened.
  manifest.file_.reset(text.empty() ? std::tmpfile()
                                    : ::fmemopen(const_cast<char*>(text.data()), text.size(), "r"));
  if (!manifest.file_) return make_error(Code::io, std::strerror(errno)).in_file(manifest.name_);
  if (auto begun = manifest.begin({}); !begun) return begun.error();
  return manifest;
}

Result<void> Manifest::begin(std::vector<std::pair<std::string, std::string>> defaults) {
  defaults_ = std::move(defaults);
  for (auto& [column, value] : defaults_) {
    column = column_named(column);
    if (!is_column(column)) return unknown_column(column, 0, 0);
  }
  return rewind();
}

Result<void> Manifest::rewind() {
  std::rewind(file_.get());
  line_ = first_ = 0;
  header_.clear();
  begun_ = in_list_ = ended_ = false;
  between_ = '\t';
  return form_ == Form::table || form_ == Form::csv ? read_header() : Result<void>();
}

Result<bool> Manifest::read_line(std::string& line) {
  line.clear();
  bool too_long = false;
  int c = 0;
  while ((c = ::getc_unlocked(file_.get())) != EOF && c != '\n') {
    if (line.size() < kMostLine) {
      line += char(c);
    } else {
      too_long = true;
    }
  }
  if (c == EOF && std::ferror(file_.get()) != 0) {
    return make_error(Code::io, std::strerror(errno)).in_file(name_);
  }
  if (c == EOF && line.empty()) return false;
  ++line_;
  if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
  if (line.ends_with('\r')) line.pop_back();
  if (too_long) return bad("the line is longer than 1 MB", line_).in_file(name_);
  if (const std::size_t zero = line.find('\0'); zero != std::string::npos) {
    return bad("a zero byte: this is no UTF-8 text", line_, std::int64_t(zero) + 1).in_file(name_);
  }
  return true;
}

// A line of a table, or the lines of one whose quotes end in a later one.
Result<bool> Manifest::read_record(std::string& text) {
  Result<bool> got = read_line(text);
  first_ = line_;
  if (!got || !*got || form_ != Form::csv) return got;
  const auto open = [&] { return std::count(text.begin(), text.end(), '"') % 2 != 0; };
  std::string more;
  while (open()) {
    got = read_line(more);
    if (!got) return got;
    if (!*got) return bad("a quote that does not end", first_).in_file(name_);
    text += "\n" + more;
    if (text.size() > kMostLine) return bad("the row is longer than 1 MB", first_).in_file(name_);
  }
  return true;
}

// A line, or the next object of a list.
Result<bool> Manifest::read_object(std::string& text) {
  text.clear();
  if (ended_) return false;
  if (!in_list_) {
    const Result<bool> got = read_line(text);
    first_ = line_;
    const std::size_t at = text.find_first_not_of(" \t");
    if (!got || !*got || begun_ || at == std::string::npos) return got;
    begun_ = true;
    if (text[at] != '[') return got;
    std::rewind(file_.get());
    line_ = 1;
    for (int c = 0; (c = ::getc_unlocked(file_.get())) != '[' && c != EOF;) line_ += c == '\n';
    in_list_ = true;
  }
  text.clear();
  // From here on a place is lost with the first error.
  const auto broken = [&](const char* what) -> Result<bool> {
    ended_ = true;
    return bad(what, line_).in_file(name_);
  };
  int depth = 0, c = 0;
  bool quoted = false, escaped = false;
  while ((c = ::getc_unlocked(file_.get())) != EOF) {
    if (c == '\n') ++line_;
    if (depth == 0) {
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',') continue;
      if (c == ']') {
        ended_ = true;
        return false;
      }
      if (c != '{') return broken("the list has something that is no object");
      first_ = line_;
    }
    if (text.size() >= kMostLine) return broken("the object is longer than 1 MB");
    text += char(c);
    if (quoted) {
      quoted = escaped || c != '"';
      escaped = !escaped && c == '\\';
      continue;
    }
    if (c == '"') quoted = true;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (depth == 0) return true;
  }
  return broken("the list does not end");
}

namespace {

// A field of a table, and where it begins.
struct Field {
  std::string text;
  std::size_t at = 0;
  bool good = true;  // false: something behind its quote
};

// The field that begins at `at`, which receives its end.
Field field_at(std::string_view line, std::size_t& at, char between) {
  Field field{{}, at, true};
  if (between == '\t' || at >= line.size() || line[at] != '"') {
    const std::size_t end = std::min(line.find(between, at), line.size());
    field.text = line.substr(at, end - at);
    at = end;
    return field;
  }
  for (++at; at < line.size(); ++at) {
    if (line[at] == '"') {
      if (at + 1 >= line.size() || line[at + 1] != '"') break;
      ++at;
    }
    field.text += line[at];
  }
  at = std::min(at + 1, line.size());
  field.good = at == line.size() || line[at] == between;
  at = std::min(line.find(between, at), line.size());
  return field;
}

}  // namespace

Result<void> Manifest::read_header() {
  std::string line;
  const Result<bool> got = read_record(line);
  if (!got) return got.error();
  if (!*got) return make_error(Code::syntax, "the manifest is empty").in_file(name_);
  if (form_ == Form::csv) {
    const auto count = [&](char c) { return std::count(line.begin(), line.end(), c); };
    between_ = count(';') > count(',') ? ';' : ',';
  }
  for (std::size_t at = 0; at <= line.size();) {
    const Field field = field_at(line, at, between_);
    const std::string name = column_named(field.text);
    const auto column = std::int64_t(field.at) + 1;
    if (!is_column(name)) return unknown_column(name, line_, column).in_file(name_);
    if (std::find(header_.begin(), header_.end(), name) != header_.end()) {
      return bad("column \"" + name + "\" is there twice", line_, column).in_file(name_);
    }
    header_.push_back(name);
    ++at;
  }
  // A dialect may have other names for its rows.
  if (!dialect_.to_row && std::find(header_.begin(), header_.end(), "id") == header_.end()) {
    return bad("there is no column \"id\"", line_).in_file(name_);
  }
  return {};
}

Result<Row> Manifest::table_row(std::string_view text) const {
  Row row;
  std::size_t number = 0;
  for (std::size_t at = 0; at <= text.size(); ++number) {
    Field field = field_at(text, at, between_);
    const auto column = std::int64_t(field.at) + 1;
    if (number >= header_.size()) {
      return bad(
          "more fields than the " + std::to_string(header_.size()) + " columns of the first line",
          first_, column);
    }
    if (!field.good) return bad("something stands behind a quote", first_, column);
    row.fill(header_[number], field.text);
    ++at;
  }
  return row;
}

Result<Row> Manifest::json_row(std::string_view text) const {
  Row row;
  const Result<Json> json = Json::parse(text);
  if (!json) return bad("this is no JSON object", first_, json.error().where.column);
  if (!json->is_object()) return bad("this is no JSON object", first_, 1);
  for (const auto& [key, value] : json->items()) {
    const std::string name = column_named(key);
    if (!is_column(name)) {
      return unknown_column(key, first_, std::int64_t(text.find("\"" + key + "\"")) + 1);
    }
    Result<std::string> one = json_value(value, first_, key);
    if (!one) return one.error();
    if (one->find('\0') != std::string::npos) return bad("a zero byte in \"" + key + "\"", first_);
    row.fill(name, *one);
  }
  return row;
}

Result<Row> Manifest::list_row(std::string_view text) const {
  Row row;
  const std::filesystem::path path{std::string(text)};
  row.fill("id", path.stem().string());
  row.fill(column_of_file(tools::extension_of(path.string())), path.string());
  return row;
}

Result<std::optional<Row>> Manifest::next() {
  for (;;) {
    std::string text;
    do {
      const Result<bool> got = form_ == Form::json ? read_object(text) : read_record(text);
      if (!got) return got.error();
      if (!*got) return std::optional<Row>();
    } while (is_blank(text));
    Result<Row> row = form_ == Form::json   ? json_row(text)
                      : form_ == Form::list ? list_row(text)
                                            : table_row(text);
    if (!row) return row.error().in_file(name_);
    row->line = first_;
    if (const std::string column = column_with_command(*row); !allow_commands_ && !column.empty()) {
      return bad("column " + column +
                     " runs a program; if you trust the manifest add --allow-commands, or name the "
                     "program on the command line: --set tts=\"COMMAND\"",
                 first_)
          .in_file(name_);
    }
    for (const auto& [column, value] : defaults_) row->fill(column, value);
    if (dialect_.to_row) {
      const Result<bool> kept = dialect_.to_row(*row);
      if (!kept) return bad(kept.error().message, first_).in_file(name_);
      if (!*kept) continue;
    }
    std::size_t at = 0;
    for (std::size_t i = 0; i < header_.size() && header_[i] != "id"; ++i) {
      static_cast<void>(field_at(text, at, between_));
      at = std::min(at + 1, text.size());
    }
    if (const std::string problem = problem_of_id(row->at("id")); !problem.empty()) {
      return bad(problem, first_, std::int64_t(at) + 1).in_file(name_);
    }
    return std::optional<Row>(std::move(*row));
  }
}

std::string problem_of_id(std::string_view id) {
  const std::string called = "id \"" + std::string(id) + "\" ";
  if (id.empty()) return "the row has no id";
  if (id.size() > kMostId) return "the id is longer than 200 bytes";
  for (const char c : id) {
    if (static_cast<unsigned char>(c) < 32 || c == 127 || c == '\\' || c == '|') {
      return "the id has a character that names of files should not have";
    }
  }
  for (std::size_t at = 0; at <= id.size();) {
    const std::size_t end = std::min(id.find('/', at), id.size());
    const std::string_view part = id.substr(at, end - at);
    if (part.empty() || part == "." || part == "..") {
      return called + "leads out of the folder, or nowhere";
    }
    if (part.front() == '.') return called + "begins with a dot: a hidden file";
    at = end + 1;
  }
  return {};
}

std::uint64_t stable_hash(std::string_view text) {
  std::uint64_t hash = 14695981039346656037U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return hash;
}

int shard_of(std::string_view id, int shards) {
  // The low bits of FNV alone are poor.
  const std::uint64_t hash = stable_hash(id);
  return int((hash ^ (hash >> 32)) % std::uint64_t(shards)) + 1;
}

}  // namespace animeme::batch
