/// @file
/// People who talk to each other: --cast of `speak`.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/app/commands/speak_parts.h"

namespace animeme::tools {

struct OptionTable;

/// Adds --cast and --turns.
void add_cast_options(OptionTable& cli, SpeakOptions& options);

/// What is wrong with options beside --cast, as a sentence; empty: nothing.
std::string problem_with_cast(const SpeakOptions& options);

/// Writes files with a face for each of them. The options are complete (--fit is read).
Result<int> speak_people(const SpeakOptions& options);

}  // namespace animeme::tools
