/// @file
/// Processes one row of a manifest.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/app/batch/manifest.h"
#include "tools/formats/files/cost.h"

namespace animeme::batch {

/// Runs a command line of the program in this process; the program's name comes first. Returns the
/// exit code.
using RunLine = std::function<int(std::span<const char* const>)>;

/// Settings shared by all rows of a batch.
struct Shared {
  std::string out;      ///< folder of the outputs
  std::string stage;    ///< folder in it for unfinished files
  std::string fetch;    ///< command that fetches an input, with {uri} and {file}; empty: none
  std::string store;    ///< command that stores an output, with {file} and {uri}; empty: none
  std::string to;       ///< prefix of {uri} for outputs
  std::string version;  ///< of the program
  RunLine run;          ///< the program
};

/// The result for a row.
struct Entry {
  std::string id;                     ///< of the row
  bool good = false;                  ///< false: `error` says why
  std::vector<std::string> outputs;   ///< files in the folder of outputs
  std::optional<double> seconds;      ///< of speech, if known
  std::uint64_t bytes = 0;            ///< of all outputs
  std::optional<double> confidence;   ///< of alignment or recognition, 0..1
  std::vector<std::string> warnings;  ///< of all commands
  std::string error;                  ///< empty: none
  std::string hash;     ///< of the row and the content of its inputs, 16 hexadecimal digits
  std::string version;  ///< of the program
};

/// A row to process.
struct Task {
  Row row;                        ///< the row
  std::string known;              ///< its hash if it was done by this version; empty: not done
  std::uint64_t known_bytes = 0;  ///< of its previous outputs
};

/// Result of a task.
struct Outcome {
  Entry entry;                                     ///< for the index
  bool same = false;                               ///< already up to date
  std::array<tools::Cost, tools::kSteps> costs{};  ///< of its steps
};

/// Runs a task in the folder stage/WORKER and moves its outputs into place when all are complete.
/// Redirects standard output and standard error meanwhile.
Outcome do_task(const Task& task, const Shared& shared, std::size_t worker);

/// The last output of a worker that ended without an answer; may be empty.
std::string last_said(const Shared& shared, std::size_t worker);

/// @{
/// Messages between processes.
std::string task_message(const Task& task);
Task read_task(std::string_view message);
std::string outcome_message(const Outcome& outcome);
Outcome read_outcome(std::string_view message);
/// @}

}  // namespace animeme::batch
