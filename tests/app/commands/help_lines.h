// The commands of the program and their options, read from --help as a user does.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "tests/support/program.h"

namespace animeme::test {

/// An option or argument that takes a value.
struct HelpLine {
  std::string name;                ///< "--rate"; of an argument "input"
  std::string value;               ///< "RATE", "OUT", "INT:0..31", without default and what follows
  bool required = false;           ///< it has to be given
  std::vector<std::string> words;  ///< of {a,b}
  bool argument() const { return name[0] != '-'; }
};

struct HelpOfCommand {
  std::string name;
  std::vector<HelpLine> lines;
};

inline std::vector<std::string> help_lines(const std::vector<std::string>& arguments) {
  std::istringstream text(animeme(arguments).out);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

inline std::vector<std::string> all_commands() {
  std::vector<std::string> names;
  bool listed = false;
  for (const std::string& line : help_lines({"--help"})) {
    if (listed && line.size() > 2 && line[2] != ' ') {
      names.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
    listed = listed || line == "Commands:";
    if (listed && line.empty()) break;
  }
  return names;
}

// "  -o,--output OUT ... REQUIRED   What to write": the name is the longest, the value has one
// blank before it. What does not fit beside them stands in the lines below.
inline bool read_help_line(const std::string& line, HelpLine& out) {
  if (line.size() < 3 || !line.starts_with("  ") || line[2] == ' ') return false;
  const std::size_t end = line.find(' ', 2);
  std::istringstream names(line.substr(2, end - 2));
  for (std::string name; std::getline(names, name, ',');) {
    if (out.name.empty() || (name.size() > out.name.size() && !out.name.starts_with("--"))) {
      out.name = name;
    }
  }
  if (end == std::string::npos || line[end + 1] == ' ') return false;  // a flag
  std::string value = line.substr(end + 1, line.find(' ', end + 1) - end - 1);
  if (value == "REQUIRED") return false;
  out.required = line.find(" REQUIRED") != std::string::npos;
  if (const std::size_t open = value.find('{'); open != std::string::npos) {
    std::istringstream words(value.substr(open + 1, value.find('}') - open - 1));
    for (std::string word; std::getline(words, word, ',');) out.words.push_back(word);
  }
  out.value = value.starts_with(">=") ? value : value.substr(0, value.find('=', 0));
  if (const std::size_t bound = value.find(":>="); bound != std::string::npos) {
    out.value = value.substr(0, value.find('=', bound + 3));
  }
  return true;
}

inline HelpOfCommand help_of(const std::string& command) {
  HelpOfCommand out{command, {}};
  const bool brief = animeme({command, "--help"}).out.find("--help-all") != std::string::npos;
  for (const std::string& line : help_lines({command, brief ? "--help-all" : "--help"})) {
    if (line.starts_with("Examples:")) break;
    HelpLine one;
    if (read_help_line(line, one)) out.lines.push_back(one);
  }
  return out;
}

}  // namespace animeme::test
