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

bool is_column(std::string_view name) {
  return std::find(kColumns.begin(), kColumns.end(), name) != kColumns.end();
}

// "language" is what many tables call it.
std::string column_named(std::string name) { return name == "language" ? "lang" : name; }

std::string all_columns() {
  std::string text;
  for (const std::string_view name : kColumns)
    text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

Error bad(std::string message, std::int64_t line, std::int64_t column = 0) {
  return error_at_line(Code::syntax, std::move(message), line, column);
}

Error unknown_column(const std::string& name, std::int64_t line, std::int64_t column) {
  return bad("there is no column \"" + name + "\"; columns are " + all_columns(), line, column);
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
  if (ending == ".jsonl" || ending == ".json" || ending == ".ndjson") return Form::json;
  return ending == ".txt" || ending == ".lst" ? Form::list : Form::table;
}

Result<Manifest> Manifest::open(const std::string& path, Form form,
                                std::vector<std::pair<std::string, std::string>> defaults,
                                bool allow_commands) {
  Manifest manifest;
  manifest.allow_commands_ = allow_commands;
  manifest.name_ = path == "-" ? "standard input" : path;
  manifest.form_ = form;
  manifest.defaults_ = std::move(defaults);
  for (const auto& [column, value] : manifest.defaults_) {
    if (!is_column(column)) return unknown_column(column, 0, 0);
  }
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
  if (auto begun = manifest.rewind(); !begun) return begun.error();
  return manifest;
}

Result<void> Manifest::rewind() {
  std::rewind(file_.get());
  line_ = 0;
  header_.clear();
  return form_ == Form::table ? read_header() : Result<void>();
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

Result<void> Manifest::read_header() {
  std::string line;
  const Result<bool> got = read_line(line);
  if (!got) return got.error();
  if (!*got) return make_error(Code::syntax, "the manifest is empty").in_file(name_);
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find('\t', at), line.size());
    const std::string name = column_named(line.substr(at, end - at));
    const auto column = std::int64_t(at) + 1;
    if (!is_column(name)) return unknown_column(name, line_, column).in_file(name_);
    if (std::find(header_.begin(), header_.end(), name) != header_.end()) {
      return bad("column \"" + name + "\" is there twice", line_, column).in_file(name_);
    }
    header_.push_back(name);
    at = end + 1;
  }
  if (std::find(header_.begin(), header_.end(), "id") == header_.end()) {
    return bad("there is no column \"id\"", line_).in_file(name_);
  }
  return {};
}

Result<Row> Manifest::table_row(std::string_view text) const {
  Row row;
  std::size_t field = 0;
  for (std::size_t at = 0; at <= text.size(); ++field) {
    const std::size_t end = std::min(text.find('\t', at), text.size());
    if (field >= header_.size()) {
      return bad(
          "more fields than the " + std::to_string(header_.size()) + " columns of the first line",
          line_, std::int64_t(at) + 1);
    }
    row.fill(header_[field], std::string(text.substr(at, end - at)));
    at = end + 1;
  }
  return row;
}

Result<Row> Manifest::json_row(std::string_view text) const {
  Row row;
  const Result<Json> json = Json::parse(text);
  if (!json) return bad("this is no JSON object", line_, json.error().where.column);
  if (!json->is_object()) return bad("this is no JSON object", line_, 1);
  for (const auto& [key, value] : json->items()) {
    const std::string name = column_named(key);
    if (!is_column(name)) {
      return unknown_column(key, line_, std::int64_t(text.find("\"" + key + "\"")) + 1);
    }
    Result<std::string> one = json_value(value, line_, key);
    if (!one) return one.error();
    if (one->find('\0') != std::string::npos) return bad("a zero byte in \"" + key + "\"", line_);
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
  std::string line;
  do {
    const Result<bool> got = read_line(line);
    if (!got) return got.error();
    if (!*got) return std::optional<Row>();
  } while (is_blank(line));
  Result<Row> row = form_ == Form::table  ? table_row(line)
                    : form_ == Form::json ? json_row(line)
                                          : list_row(line);
  if (!row) return row.error().in_file(name_);
  row->line = line_;
  if (const std::string column = column_with_command(*row); !allow_commands_ && !column.empty()) {
    return bad("column " + column +
                   " runs a program; if you trust the manifest add --allow-commands, or name the "
                   "program on the command line: --set tts=\"COMMAND\"",
               line_)
        .in_file(name_);
  }
  for (const auto& [column, value] : defaults_) row->fill(column, value);
  std::size_t at = 0;
  for (std::size_t i = 0; i < header_.size() && header_[i] != "id"; ++i)
    at = line.find('\t', at) + 1;
  if (const std::string problem = problem_of_id(row->at("id")); !problem.empty()) {
    return bad(problem, line_, std::int64_t(at) + 1).in_file(name_);
  }
  return std::optional<Row>(std::move(*row));
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
