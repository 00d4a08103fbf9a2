/// @file
/// Runs a suite of cases against this decoder or a foreign one.
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

/// What a decoder made of a case.
enum class Verdict : std::uint8_t {
  exact,     ///< masks, frame numbers, rate and values
  values,    ///< every coded value, but more than that, or other numbers
  ignored,   ///< damaged case: the damage was not seen, the values are right all the same
  stopped,   ///< damaged case: what was written is right and ends at the damage
  wrong,     ///< a value, a frame or an error is not right
  encoder,   ///< decoded exactly, but written again it is another stream (this codec alone)
  error,     ///< the decoder refused, or gave nothing that can be read
  crash,     ///< it ended by a signal
  timeout,   ///< it did not end in time
  skipped,   ///< it cannot be asked: a body, and the command has no {bap}
  bad_data,  ///< a file of the case is missing or was changed
};
const char* verdict_name(Verdict verdict);  ///< as in reports
/// exact, values, ignored and stopped.
bool is_right(Verdict verdict);

/// One case after it was run.
struct CaseResult {
  const SuiteCase* one = nullptr;      ///< borrowed from the suite
  Verdict verdict = Verdict::skipped;  ///< what came of it
  std::string detail;                  ///< one sentence without a full stop, may be empty
  FirstDifference difference;          ///< if values are wrong
  bool encoded_again = false;          ///< the byte-exact check of the encoder was made and passed
  ChildEnd end;                        ///< of the foreign program
};

/// How a suite is run.
struct RunOptions {
  std::optional<CommandTemplate> command;  ///< empty: this decoder
  bool encode = true;                      ///< this codec: write the streams again, too
  double timeout_seconds = 10;             ///< for each child
  std::size_t jobs = 1;                    ///< cases at once
  /// Called as each case ends.
  std::function<void(std::size_t done, const std::string& name)> progress;
};

/// Runs the cases, in the order given; results are in that order. A case that crashes or hangs is
/// a verdict. Errors: io (no scratch folder, no processes).
Result<std::vector<CaseResult>> run_suite(const std::vector<const SuiteCase*>& cases,
                                          const RunOptions& options);

}  // namespace animeme::tools
