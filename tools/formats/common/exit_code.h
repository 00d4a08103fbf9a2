/// @file
/// Exit codes.
#pragma once

namespace animeme::tools {

/// Exit codes of the program.
enum ExitCode : int {
  kOk = 0,
  kCheckFailed = 1,
  kUsage = 2,
  kBadInput = 3,
  kInternal = 4,
  kInterrupted = 130,  ///< Ctrl-C; outputs are complete up to this point
};

}  // namespace animeme::tools
