/// @file
/// One row of a manifest, done.
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

/// What all rows of a batch share.
struct Shared {
  std::string out;      ///< folder of the outputs
  std::string stage;    ///< folder in it for what is not finished
  std::string fetch;    ///< command that brings an input, with {uri} and {file}; empty: none
  std::string store;    ///< command that takes an output away, with {file} and {uri}; empty: none
  std::string to;       ///< what {uri} of outputs begins with
  std::string version;  ///< of the program
  RunLine run;          ///< the program
};

/// What was done before, or is done now, for a row.
struct Entry {
  std::string id;                     ///< of the row
  bool good = false;                  ///< false: `error` says why
  std::vector<std::string> outputs;   ///< files in the folder of outputs
  std::optional<double> seconds;      ///< of speech, where it is known
  std::uint64_t bytes = 0;            ///< of all outputs
  std::optional<double> confidence;   ///< of alignment or listening, 0..1
  std::vector<std::string> warnings;  ///< of all commands
  std::string error;                  ///< empty: none
  std::string hash;     ///< of the row and the content of its inputs, 16 hexadecimal digits
  std::string version;  ///< of the program that did it
};

/// A row to do.
struct Task {
  Row row;                        ///< what is wanted
  std::string known;              ///< hash of it when it was done by this version; empty: never
  std::uint64_t known_bytes = 0;  ///< of its outputs then
};

/// How a task ended.
struct Outcome {
  Entry entry;                                     ///< for the index
  bool same = false;                               ///< nothing had to be done
  std::array<tools::Cost, tools::kSteps> costs{};  ///< of its steps
};

/// Does a task in the folder stage/WORKER, and moves what it made to its place when all of it is
/// there. Standard output and standard error belong to it meanwhile.
Outcome do_task(const Task& task, const Shared& shared, std::size_t worker);

/// What a worker that has ended without an answer said of its reason; empty: nothing.
std::string last_said(const Shared& shared, std::size_t worker);

/// @{
/// Messages between processes.
std::string task_message(const Task& task);
Task read_task(std::string_view message);
std::string outcome_message(const Outcome& outcome);
Outcome read_outcome(std::string_view message);
/// @}

}  // namespace animeme::batch
