/// @file
/// What a command line that was not understood may have meant.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/app/commands/options.h"

namespace animeme::tools {

/// The name among `names` that is nearest to what was typed: letters left out, put in, changed or
/// swapped with their neighbour, in at most a third of it. Empty: none is near. Of equals the
/// first.
std::string nearest_name(const std::string& typed, const std::vector<std::string>& names);

/// A sentence for a command line that did not parse: the command that does not exist, or the
/// options, and what they are like. Empty: nothing of it is wrong in that way. `words`: those
/// behind the program's name.
std::string did_you_mean(const OptionTable& program, std::span<const char* const> words);

}  // namespace animeme::tools
