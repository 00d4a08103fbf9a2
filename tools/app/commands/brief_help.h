/// @file
/// A command with more options than a page holds: --help shows the usual ones, --help-all all.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace animeme::tools {

/// Adds --help-all to a command whose other options are added already, and shows the options of
/// these names ("--mtu") there alone, beneath `title`.
void show_in_help_all(CLI::App& app, const std::string& title,
                      const std::vector<std::string>& names);

}  // namespace animeme::tools
