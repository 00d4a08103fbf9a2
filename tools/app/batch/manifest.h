/// @file
/// A manifest: a row a clip, read as a stream, so that a million rows take no more memory than one.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fap/result.h"

namespace animeme::batch {

/// The columns that a manifest may have.
inline constexpr std::array<std::string_view, 18> kColumns = {"id",
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

/// How rows are written.
enum class Form : std::uint8_t {
  table,  ///< columns between tabs, their names in the first line
  json,   ///< an object a line
  list,   ///< the path of a file a line
};

/// The form of a manifest by its name: .jsonl or .json, .txt or .lst, else a table.
Form form_of(const std::string& path);

/// Reads rows one by one. Lines may end with CR; a byte order mark is skipped, as are blank lines.
class Manifest {
 public:
  /// "-" is standard input, which is copied to a file without a name, so that it can be read twice.
  /// `defaults`: values for columns that a row leaves empty.
  /// Errors, with file, line and column: not_found, io, syntax (a column that there is not, or
  /// twice; no column id).
  static Result<Manifest> open(const std::string& path, Form form,
                               std::vector<std::pair<std::string, std::string>> defaults);
  /// The next row; nothing behind the last. Errors: syntax, for this row; the next call goes on.
  Result<std::optional<Row>> next();
  /// From the first row again. Errors: io, syntax.
  Result<void> rewind();
  const std::string& name() const { return name_; }  ///< for messages

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  Result<bool> read_line(std::string& line);
  Result<void> read_header();
  Result<Row> table_row(std::string_view text) const;
  Result<Row> json_row(std::string_view text) const;
  Result<Row> list_row(std::string_view text) const;

  std::unique_ptr<std::FILE, Close> file_;
  std::string name_;
  Form form_ = Form::table;
  std::vector<std::pair<std::string, std::string>> defaults_;
  std::vector<std::string> header_;
  std::int64_t line_ = 0;
};

/// What is wrong with an id as the name of files below a folder, as a sentence; empty: nothing.
std::string problem_of_id(std::string_view id);

/// 64 bits of a text by FNV-1a: the same everywhere and for ever.
std::uint64_t stable_hash(std::string_view text);

/// Which of `shards` parts, from 1, a clip belongs to.
int shard_of(std::string_view id, int shards);

}  // namespace animeme::batch
