/// @file
/// A program of others, run to its end.
#pragma once

#include <functional>
#include <string>

#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/formats/programs/children.h"

namespace animeme::tools {

/// How a program is run and spoken of.
struct ProgramRun {
  std::string what = "the program";  ///< subject of error messages: "the tracker"
  std::string allow_more;            ///< how to allow more time, for messages: "--tracker-seconds"
  double seconds = 60;               ///< then it is ended
  Progress progress;                 ///< told a share where `share_told` finds one; may stop it
  /// How far a line of what it says on standard error tells that it is, 0..1, or a negative number:
  /// such lines are no last words. Empty: no line does.
  std::function<double(const std::string& line)> share_told;
};

/// Runs `job`, whose `err` must be set, and waits. Errors: those of Children::start();
/// io (progress.stop()), out_of_range (too long), not_found (it crashed, or ended with another
/// exit code than 0); the last two end with what it said last.
Result<void> run_program(const ChildJob& job, const ProgramRun& run);

/// "; it said: " and the last lines that a program wrote to the file `err`; empty if it wrote none.
std::string last_words(const std::string& err, const ProgramRun& run);

}  // namespace animeme::tools
