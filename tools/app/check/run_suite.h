/// @file
/// Runs a suite of cases on this decoder or an external one.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/app/check/coded_values.h"
#include "tools/app/check/suite.h"
#include "tools/formats/programs/children.h"
#include "tools/formats/programs/command_template.h"

namespace animeme::tools {

/// Result of a decoder for a case.
enum class Verdict : std::uint8_t {
  exact,     ///< masks, frame numbers, rate and values
  values,    ///< every coded value, but additional values or other frame numbers
  ignored,   ///< damaged case: the damage was not detected, but the values are correct
  stopped,   ///< damaged case: the output is correct and ends at the damage
  wrong,     ///< a wrong value, frame or error
  encoder,   ///< decoded exactly, but re-encoding gives another stream (this codec only)
  error,     ///< the decoder failed, or its output is unreadable
  crash,     ///< it was ended by a signal
  timeout,   ///< it did not end in time
  skipped,   ///< it cannot be run: a body, and the command has no {bap}
  bad_data,  ///< a file of the case is missing or was changed
};
const char* verdict_name(Verdict verdict);  ///< as in reports
/// exact, values, ignored and stopped.
bool is_right(Verdict verdict);

/// Result of one case.
struct CaseResult {
  const SuiteCase* one = nullptr;      ///< borrowed from the suite
  Verdict verdict = Verdict::skipped;  ///< the verdict
  std::string detail;                  ///< one sentence without a full stop, may be empty
  FirstDifference difference;          ///< if values are wrong
  /// False: a failure here does not make the run fail, since the standard does not settle the case.
  bool counts = true;
  bool encoded_again = false;  ///< the byte-exact encoder check was run and passed
  ChildEnd end;                ///< of the external program
};

/// Options for a run.
struct RunOptions {
  std::optional<CommandTemplate> command;  ///< empty: this decoder
  bool encode = true;                      ///< this codec: also re-encode the streams
  double timeout_seconds = 10;             ///< for each child
  std::size_t jobs = 1;                    ///< cases at once
  /// Called when a case ends.
  std::function<void(std::size_t done, const std::string& name)> progress;
};

/// Runs the cases, in the order given; results are in that order. A case that crashes or hangs is
/// a verdict. Errors: io (no scratch folder, no processes).
Result<std::vector<CaseResult>> run_suite(const std::vector<const SuiteCase*>& cases,
                                          const RunOptions& options);

}  // namespace animeme::tools
