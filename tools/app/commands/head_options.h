/// @file
/// The options of commands that show a head.
#pragma once

#include <string>
#include <vector>

#include "tools/view/studio/head_file.h"

namespace animeme::tools {

struct OptionTable;
struct Option;

/// What --help says of --head and --points.
extern const char* const kHeadHelp;
extern const char* const kPointsHelp;  ///< likewise

/// Adds --gain.
Option* add_gain_option(OptionTable& cli, studio::HeadChoice& choice);

/// Adds --shape-name and --shape-names.
void add_shape_options(OptionTable& cli, studio::HeadChoice& choice);

/// Adds --head, --points, --shape-name, --shape-names and --gain.
void add_head_options(OptionTable& cli, studio::HeadChoice& choice);

/// The same for several heads: --head takes a list, or is given several times; `heads` gets
/// them as they are written, for HeadChoices::each().
void add_heads_options(OptionTable& cli, std::vector<std::string>& heads,
                       studio::HeadChoice& choice);

}  // namespace animeme::tools
