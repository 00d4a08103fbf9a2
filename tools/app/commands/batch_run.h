/// @file
/// Running a batch from a command: its settings, its progress on standard error, and what it cost.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/app/batch/batch.h"
#include "tools/formats/common/json.h"

namespace animeme::tools {

/// Sets what all commands that run batches have in common: the number of workers (0: one per core),
/// the version, and the program itself as what workers run.
void prepare_batch(batch::Settings& settings, unsigned jobs);

/// Runs a batch. Progress and failed rows are shown on standard error; Ctrl-C lets running rows
/// finish. `what`: the rows, "clips". `seconds` receives how long it took. Errors: those of
/// batch::run_batch().
Result<batch::Ending> run_batch_shown(const batch::Settings& settings, const char* what,
                                      double& seconds);

/// "1:05" or "2:01:05".
std::string clock_text(double seconds);

/// CPU seconds of all steps.
double cpu_seconds(const batch::Standing& standing);

/// CPU seconds and bytes of each step.
Json steps_json(const batch::Standing& standing);

}  // namespace animeme::tools
