/// @file
/// What a command has written, in words and for --json.
#pragma once

#include <string>

#include "tools/formats/common/json.h"

namespace animeme::tools {

/// Prints "path: text" on standard error, and notes {"output": path, facts ...} for the report that
/// --json prints on standard output when the command ends.
void report_output(const std::string& path, const std::string& text, Json facts = Json::object());
/// For a command that is about to print data on standard output: a sentence if --json was given,
/// too; else empty.
std::string problem_with_report();
/// For a command that has printed its own report: errors are no longer printed as JSON, too.
void report_printed();
/// The report: {"outputs": [...], "warnings": [...]}, of what came since the command began.
std::string report_text();

}  // namespace animeme::tools
