/// @file
/// A manifest with one row per clip, read as a stream in constant memory.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fap/result.h"

namespace animeme::batch {

/// The columns of a manifest.
inline constexpr std::array<std::string_view, 19> kColumns = {"id",
                                                              "text",
                                                              "text_file",
                                                              "script",
                                                              "audio",
                                                              "transcript",
                                                              "input",
                                                              "lang",
                                                              "voice",
                                                              "tts",
                                                              "model",
                                                              "head",
                                                              "over",
                                                              "options",
                                                              "encode_options",
                                                              "render_options",
                                                              "export_options",
                                                              "align_options",
                                                              "outputs"};

/// A row: columns that are not empty, by name.
struct Row {
  std::int64_t line = 0;                                    ///< in the manifest, from 1
  std::vector<std::pair<std::string, std::string>> values;  ///< column and value
  /// The value of a column; empty: none.
  std::string_view at(std::string_view column) const;
  /// Sets the value of a column that has none.
  void fill(std::string_view column, const std::string& value);
};

/// Formats of a manifest.
enum class Form : std::uint8_t {
  table,  ///< columns separated by tabs, names in the first line
  csv,    ///< the same by commas or semicolons, fields in quotes where needed (RFC 4180)
  json,   ///< one object per line, or a list of objects
  list,   ///< one file path per line
};

/// The form of a manifest by its name: .jsonl or .json, .csv, .txt or .lst, else a table.
Form form_of(const std::string& path);

/// A table of another command, whose rows are turned into those of a batch.
struct Dialect {
  std::span<const std::string_view> columns;  ///< in place of kColumns; static storage
  /// Makes a row of a batch of a row, with its id; false: leave it out. An error is one of syntax.
  std::function<Result<bool>(Row&)> to_row;
};

/// Reads rows one by one. Lines may end with CR; a byte order mark is skipped, as are blank lines.
class Manifest {
 public:
  /// "-" is standard input, which is copied to a file without a name, so that it can be read twice.
  /// `defaults`: values for columns that a row leaves empty. `allow_commands`: whether rows may
  /// name programs to run (column tts, --tts in options); a manifest is data, which others write.
  /// Errors, with file, line and column: not_found, io, syntax (an unknown or duplicate column; no
  /// column id).
  static Result<Manifest> open(const std::string& path, Form form,
                               std::vector<std::pair<std::string, std::string>> defaults,
                               bool allow_commands = false, const Dialect& dialect = {});
  /// The same of a text in memory, which lives as long.
  static Result<Manifest> of_text(std::string_view text, Form form, bool allow_commands = false);
  /// The next row; nullopt after the last. Errors: syntax (also of a row that names a program,
  /// unless these are allowed), for this row only; the next call continues.
  Result<std::optional<Row>> next();
  /// Restarts at the first row. Errors: io, syntax.
  Result<void> rewind();
  const std::string& name() const { return name_; }  ///< for messages

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  Result<void> begin(std::vector<std::pair<std::string, std::string>> defaults);
  Result<bool> read_line(std::string& line);
  Result<bool> read_record(std::string& text);
  Result<bool> read_object(std::string& text);
  Result<void> read_header();
  bool is_column(std::string_view name) const;
  Error unknown_column(const std::string& name, std::int64_t line, std::int64_t column) const;
  Result<Row> table_row(std::string_view text) const;
  Result<Row> json_row(std::string_view text) const;
  Result<Row> list_row(std::string_view text) const;

  std::unique_ptr<std::FILE, Close> file_;
  std::string name_;
  Form form_ = Form::table;
  std::vector<std::pair<std::string, std::string>> defaults_;
  std::vector<std::string> header_;
  Dialect dialect_;
  std::int64_t line_ = 0;   // the last one that was read
  std::int64_t first_ = 0;  // of the row
  char between_ = '\t';     // fields of a table
  bool begun_ = false;      // JSON: something was read that is not blank
  bool in_list_ = false;    // JSON: behind the bracket
  bool ended_ = false;      // the list is over, or broken
  bool allow_commands_ = false;
};

/// Checks an id as a file name below a folder; returns a sentence, or empty if it is valid.
std::string problem_of_id(std::string_view id);

/// 64-bit FNV-1a hash of a text, the same on all machines and in all versions.
std::uint64_t stable_hash(std::string_view text);

/// Which of `shards` parts, from 1, a clip belongs to.
int shard_of(std::string_view id, int shards);

}  // namespace animeme::batch
