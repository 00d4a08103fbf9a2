/// @file
/// What --help says, as data: for man pages and the completions of shells.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace animeme::tools {

/// An option, or an argument without a name.
struct HelpOption {
  std::vector<std::string> names;  ///< "-o", "--output"; of an argument its one name
  std::string value;               ///< what stands behind it, as "TEXT=woman"; empty: nothing does
  std::string text;                ///< what it does
  std::vector<std::string> words;  ///< the values that it takes, if these are few
  bool required = false;           ///< it has to be given
};

/// The program, or one of its commands.
struct HelpTable {
  std::string name;                   ///< "speak"; of the program "animeme"
  std::string summary;                ///< one line, of the program several
  std::string footer;                 ///< the lines below the options
  std::vector<HelpOption> arguments;  ///< without names
  std::vector<HelpOption> options;    ///< all, also those of --help-all
  std::vector<HelpTable> commands;    ///< of the program
};

/// Reads the tables of CLI11.
HelpTable help_table(const CLI::App& app);

/// A page for man(7), of a command as `animeme-NAME`. `version`: "0.1.0".
std::string man_page(const HelpTable& table, const HelpTable& program, const std::string& version);

/// A script that completes commands, options and their values: for "bash", "zsh" or "fish".
std::string completion(const HelpTable& program, const std::string& shell);

}  // namespace animeme::tools
