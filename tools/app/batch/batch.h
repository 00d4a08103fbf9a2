/// @file
/// A batch: processes the rows of a manifest on all cores; can be resumed, split into shards and
/// joined.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fap/result.h"
#include "tools/app/batch/index.h"
#include "tools/app/batch/work.h"

namespace animeme::batch {

/// Settings of a batch.
struct Settings {
  std::string manifest;                                       ///< "-": standard input
  Form form = Form::table;                                    ///< format of the manifest
  std::vector<std::pair<std::string, std::string>> defaults;  ///< for empty columns
  Shared shared;                                              ///< its `stage` is set by run_batch()
  std::size_t jobs = 1;                                       ///< workers
  bool resume = false;                                        ///< skip finished rows
  bool allow_commands = false;                                ///< rows may name programs to run
  Dialect dialect;                                            ///< of the manifest
  bool report = true;                                         ///< write report.html
  int shard = 1;                                              ///< from 1
  int shards = 1;                                             ///< number of shards
};

/// Progress of a batch.
struct Standing {
  std::uint64_t wanted = 0;                        ///< clips of this shard
  std::uint64_t done = 0;                          ///< clips, including skipped and failed ones
  std::uint64_t skipped = 0;                       ///< clips that were already done
  std::uint64_t failed = 0;                        ///< clips with an error
  double speech_seconds = 0;                       ///< of clips done in this run
  std::array<tools::Cost, tools::kSteps> costs{};  ///< of all workers
};

/// Callbacks.
struct Watch {
  std::function<void(const Standing&)> at = [](const Standing&) {
  };  ///< called often, and after each row
  std::function<void(const std::string&)> failed = [](const std::string&) {
  };                                                  ///< called with a line for each failed row
  std::function<bool()> stop = [] { return false; };  ///< true: finish running rows and stop
};

/// Result of a batch.
struct Ending {
  Standing standing;     ///< at the end
  Totals totals;         ///< of the index; empty if it was stopped
  bool stopped = false;  ///< by Watch::stop
};

/// Reads a whole manifest and reports problems: the first twenty errors, with file, line and
/// column; duplicate ids, ids that differ only by case, or outputs that are the same file. Returns
/// the number of rows of this shard.
Result<std::uint64_t> check_manifest(Manifest& manifest, int shard, int shards,
                                     std::vector<std::string>& problems);

/// All problems as one error, syntax.
Error problem_error(const std::vector<std::string>& problems);

/// Runs a batch. Errors: io; invalid_argument (the folder has a batch and `resume` is not set);
/// syntax with all problems found by check_manifest().
Result<Ending> run_batch(const Settings& settings, const Watch& watch);

/// Joins the indices of all shards in the folder to index.tsv. Errors: not_found (no shards, or
/// some are missing or incomplete), io (a missing output).
Result<Totals> join_batch(const Settings& settings);

}  // namespace animeme::batch
