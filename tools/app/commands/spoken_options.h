/// @file
/// The options of commands that speak.
#pragma once

#include <string>

#include "tools/speech/talking/spoken.h"

namespace animeme::tools {

struct OptionTable;

/// Adds --text, --text-file, --script, --tier, --speaker, --speak-marks, --script-format, --audio,
/// --transcript, --lang,
/// --speed, --pitch.
void add_spoken_options(OptionTable& cli, speech::SpokenOptions& options);

/// A sentence about what is missing on the command line, empty if nothing is.
std::string missing_options(const speech::SpokenOptions& options);

/// Error out_of_range if words of a transcript have a lower confidence than `least`, with their
/// names.
Result<void> check_words(const voice::Alignment& alignment, double least);

}  // namespace animeme::tools
