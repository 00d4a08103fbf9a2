/// @file
/// A batch: the rows of a manifest, done by all cores, resumed, cut into shards and joined.
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

/// What is done and how.
struct Settings {
  std::string manifest;                                       ///< "-": standard input
  Form form = Form::table;                                    ///< how it is written
  std::vector<std::pair<std::string, std::string>> defaults;  ///< for columns that are empty
  Shared shared;                                              ///< its stage is chosen here
  std::size_t jobs = 1;                                       ///< workers
  bool resume = false;                                        ///< skips what is done
  int shard = 1;                                              ///< from 1
  int shards = 1;                                             ///< how many there are
};

/// How far a batch is.
struct Standing {
  std::uint64_t wanted = 0;   ///< clips of this shard
  std::uint64_t done = 0;     ///< clips, with those that were skipped or failed
  std::uint64_t skipped = 0;  ///< clips that were done before
  std::uint64_t failed = 0;   ///< clips with an error
  double speech_seconds = 0;  ///< of what was done now
  std::array<tools::Cost, tools::kSteps> costs{};  ///< of all workers
};

/// Who is told, and who may stop it.
struct Watch {
  std::function<void(const Standing&)> at = [](const Standing&) {};  ///< after each row, and often
  std::function<void(const std::string&)> failed = [](const std::string&) {};  ///< a row, by a line
  std::function<bool()> stop = [] { return false; };  ///< true: what runs is finished, no more
};

/// How a batch ended.
struct Ending {
  Standing standing;     ///< at the end
  Totals totals;         ///< of the index; of nothing where it was stopped
  bool stopped = false;  ///< by Watch::stop
};

/// Reads a manifest to its end and tells what is wrong: the first twenty errors, by file, line and
/// column; ids that are twice, or differ by case alone, or whose outputs would be the same file.
/// Returns the rows of this shard.
Result<std::uint64_t> check_manifest(Manifest& manifest, int shard, int shards,
                                     std::vector<std::string>& problems);

/// All of what is wrong as one error, syntax.
Error problem_error(const std::vector<std::string>& problems);

/// Does a batch. Errors: io; invalid_argument (the folder has a batch and `resume` is not set);
/// syntax with all that check_manifest() found.
Result<Ending> run_batch(const Settings& settings, const Watch& watch);

/// Makes index.tsv of the indices of all shards in the folder. Errors: not_found (no shards, or
/// some are missing or not complete), io (an output is not there).
Result<Totals> join_batch(const Settings& settings);

}  // namespace animeme::batch
