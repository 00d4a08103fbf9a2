/// @file
/// The options of commands that read a script: which of its tiers and speakers, and in what format.
#pragma once

#include <string>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/speech/talking/voice_file.h"

namespace animeme::tools {

struct OptionTable;

/// Adds --tier, --speaker, --speak-marks and --script-format.
void add_script_options(OptionTable& cli, dam::ScriptOptions& reading);

/// The same for commands that have no --lang: adds it for words that come without phones.
void add_script_options(OptionTable& cli, dam::ScriptOptions& reading, std::string& language);

/// The script of the motion in some files: `path`, where one was named, else what the first of the
/// files carries that has one (speech::carried_script()), else an empty one. Errors: those of
/// speech::read_script().
Result<dam::Script> script_for(const std::string& path, const std::vector<std::string>& files,
                               const speech::ScriptInput& reading);

/// Reads "FORMAT", "FORMAT:words", "FORMAT:phones", "FORMAT@RATE" or several of them; a sentence
/// about what is wrong, empty if nothing is.
std::string parse_script_format(const std::string& text, dam::ScriptOptions& reading);

}  // namespace animeme::tools
