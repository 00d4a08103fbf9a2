/// @file
/// Runs an external program to its end.
#pragma once

#include <functional>
#include <string>

#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/formats/programs/children.h"

namespace animeme::tools {

/// How to run a program and report on it.
struct ProgramRun {
  std::string what = "the program";  ///< subject of error messages: "the tracker"
  std::string
      allow_more;       ///< option that extends the time limit, for messages: "--tracker-seconds"
  double seconds = 60;  ///< time limit
  Progress progress;    ///< receives what `share_told` finds; may stop the program
  /// Extracts progress (0..1) from a line of its standard error, or returns a negative number if
  /// there is none. Progress lines are not part of error messages. Empty: none.
  std::function<double(const std::string& line)> share_told;
};

/// Runs `job`, whose `err` must be set, and waits. Errors: those of Children::start(); io
/// (progress.stop()), out_of_range (too long), not_found (it crashed, or its exit code was not 0);
/// the last two end with the last output of the program.
Result<void> run_program(const ChildJob& job, const ProgramRun& run);

/// "; it said: " and the last lines that a program wrote to the file `err`; empty if there are
/// none.
std::string last_words(const std::string& err, const ProgramRun& run);

}  // namespace animeme::tools
