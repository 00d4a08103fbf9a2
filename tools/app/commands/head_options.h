/// @file
/// The options of commands that show a head.
#pragma once

#include <string>
#include <vector>

#include "tools/view/studio/head_file.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace animeme::tools {

/// What --help says of --head and --points.
extern const char* const kHeadHelp;
extern const char* const kPointsHelp;  ///< likewise

/// Adds --gain.
CLI::Option* add_gain_option(CLI::App& app, studio::HeadChoice& choice);

/// Adds --head, --points and --gain.
void add_head_options(CLI::App& app, studio::HeadChoice& choice);

/// The same for several heads: --head takes a list, or is given several times; `heads` gets one
/// name or file each. A file whose name has commas is one head.
void add_heads_options(CLI::App& app, std::vector<std::string>& heads, studio::HeadChoice& choice);

}  // namespace animeme::tools
