/// @file
/// `animeme head --speak-test`.
#pragma once

#include <string>

#include "fap/result.h"
#include "tools/view/studio/head_file.h"

namespace animeme::tools {

/// Prints how a head speaks (studio::check_speech()), as a table or as JSON, and draws its visemes
/// into `sheet` (empty: no picture). Errors: those of load_head() and check_speech(), of drawing
/// and writing; a usage error for an ending that is no picture.
Result<int> test_speech(const studio::HeadChoice& choice, const std::string& sheet, bool json);

}  // namespace animeme::tools
