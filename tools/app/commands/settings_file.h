/// @file
/// Options of a command in a file, for services: each line is `name = value`, with the names of the
/// options without their dashes.
///
///     # comments and blank lines are ignored
///     listen = http://0.0.0.0:8080
///     max-heads = 50
///     make-on-say = true
///     model = ada=/srv/ada.dam
///     model = ben=/srv/ben.dam
///
/// An option that may be repeated has several lines.
///
/// Flags are true or false. What is also on the command line counts there.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/app/commands/options.h"

namespace animeme::tools {

/// The words that the file named by `--settings` of a command line stands for; nothing: it names
/// none, or the command has no such option. Errors: those of read_file(), invalid_argument (with
/// file and line: an unknown name, a flag that is neither true nor false, no "=", a name that is
/// there twice and may not be repeated).
Result<std::vector<std::string>> settings_words(const OptionTable& command,
                                                std::span<const char* const> words);

}  // namespace animeme::tools
