/// @file
/// The options of commands that show a head.
#pragma once

#include "tools/studio/head_file.h"

namespace CLI {
class App;
}

namespace animeme::tools {

/// What --help says of --head and --points.
extern const char* const kHeadHelp;
extern const char* const kPointsHelp;  ///< likewise
extern const char* const kGainHelp;    ///< likewise

/// Adds --head, --points and --gain.
void add_head_options(CLI::App& app, studio::HeadChoice& choice);

}  // namespace animeme::tools
