/// @file
/// index.tsv: one line per clip. Its content depends only on the manifest, not on time, order or
/// machine, so that the indices of two runs can be compared.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/app/batch/manifest.h"
#include "tools/app/batch/work.h"

namespace animeme::batch {

/// "index.tsv", or that of a shard: "index.2-of-4.tsv".
std::string index_name(int shard, int shards);

/// The first line of an index, with its end.
std::string_view index_header();
/// The line of an entry, with its end.
std::string index_line(const Entry& entry);
/// Parses a line without its end; nullopt: not an entry.
std::optional<Entry> read_index_line(std::string_view line);

/// The position of the last line of each clip; takes 40 bytes per clip.
class Index {
 public:
  /// Reads a file; a missing file has no lines. An incomplete last line, left by a killed program,
  /// is cut off if `repair`, else ignored. Errors: io, syntax (not an index).
  static Result<Index> open(const std::string& path, bool repair);

  /// Properties of a clip.
  struct Known {
    std::uint64_t id = 0;      ///< stable_hash()
    std::uint64_t work = 0;    ///< stable_hash() of hash and version; 0: failed
    std::uint64_t bytes = 0;   ///< of its outputs
    std::int64_t offset = 0;   ///< of its line in the file
    std::uint32_t length = 0;  ///< of its line, with its end
  };
  /// nullptr: it has no line.
  const Known* find(std::string_view id) const;
  /// The line itself, with its end. Errors: io.
  Result<std::string> line(const Known& known) const;
  std::size_t size() const { return known_.size(); }  ///< clips

 private:
  std::string path_;
  std::vector<Known> known_;  // ascending by id
};

/// Appends complete lines, each with one system call.
class IndexWriter {
 public:
  /// Errors, io.
  static Result<IndexWriter> open(const std::string& path);
  IndexWriter(IndexWriter&& other) noexcept;  ///< leaves the other one without a file
  IndexWriter(const IndexWriter&) = delete;
  ~IndexWriter();
  Result<void> add(const Entry& entry);  ///< errors: io

 private:
  IndexWriter(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  std::string path_;
  int descriptor_;
};

/// Totals of a batch.
struct Totals {
  std::uint64_t rows = 0;           ///< clips with a line
  std::uint64_t good = 0;           ///< clips without an error
  std::uint64_t failed = 0;         ///< clips with an error
  std::uint64_t with_warnings = 0;  ///< good ones with warnings
  std::uint64_t missing = 0;        ///< clips without a line
  double seconds = 0;               ///< of speech
  std::uint64_t bytes = 0;          ///< of outputs
};

/// Writes `to` with the lines of the clips of a manifest, in its order, and report.html next to it
/// (REPORT), worst rows first. `index_of`: the index that has a clip's line; nullptr: omit the
/// clip. Errors: io, those of the manifest.
Result<Totals> put_in_order(Manifest& manifest,
                            const std::function<const Index*(std::string_view id)>& index_of,
                            const std::string& to, const std::string& report);

}  // namespace animeme::batch
