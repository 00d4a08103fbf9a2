// The shell examples of a README: indented blocks, and fenced ones that say sh or console.
#pragma once

#include <string>
#include <vector>

#include "tests/support/files.h"

namespace animeme::test {

/// Lines that are run one behind the other.
struct Example {
  std::string readme;                 ///< "tools/view/render/README.md"
  int line = 0;                       ///< of the first one, from 1
  std::vector<std::string> lines;     ///< without comments, continued lines as one
  std::vector<std::string> left_out;  ///< what "needs ..." keeps from being run
};

/// Where the comment of a line begins: # behind a blank, outside of quotes.
inline std::size_t comment_at(const std::string& line) {
  char quote = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#' && (i == 0 || line[i - 1] == ' ')) {
      return i;
    }
  }
  return line.size();
}

/// Whether a line runs the program: at its beginning, or behind |, & or ;.
inline bool runs_animeme(const std::string& line) {
  const std::string name = "animeme ";
  for (std::size_t at = line.find(name); at != std::string::npos; at = line.find(name, at + 1)) {
    std::string before = line.substr(0, at);
    for (const char* path : {"build/release/bin/", "mpirun -n 8 "}) {
      if (before.ends_with(path)) before.resize(before.size() - std::string(path).size());
    }
    const std::size_t last = before.find_last_not_of(' ');
    if (last == std::string::npos || std::string("|&;").find(before[last]) != std::string::npos) {
      return true;
    }
  }
  return false;
}

/// One paragraph of code.
struct Paragraph {
  int line = 0;
  std::string section;
  std::vector<std::string> text;
};

inline std::vector<Paragraph> paragraphs_of(const std::string& markdown) {
  std::vector<Paragraph> all;
  std::string section;
  bool fenced = false, shell = false, open = false;
  int number = 0;
  std::size_t at = 0;
  while (at < markdown.size()) {
    const std::size_t end = std::min(markdown.find('\n', at), markdown.size());
    const std::string line = markdown.substr(at, end - at);
    at = end + 1;
    ++number;
    if (line.starts_with("```")) {
      shell = !fenced && (line == "```sh" || line == "```console");
      fenced = !fenced;
      open = false;
      continue;
    }
    if (!fenced && line.starts_with("## ")) section = line;
    const bool code = fenced ? shell && !line.empty() : line.starts_with("    ");
    if (!code) {
      open = false;
      continue;
    }
    if (!open) all.push_back({number, section, {}});
    open = true;
    all.back().text.push_back(fenced ? line : line.substr(4));
  }
  return all;
}

/// The lines of a paragraph as a shell has them: transcripts without what was printed, comments and
/// the contents of files (which are indented once more) gone, continued lines joined.
inline void add_lines(const Paragraph& paragraph, Example& out) {
  bool transcript = false;
  for (const std::string& line : paragraph.text) transcript |= line.starts_with("$ ");
  std::string joined;
  bool needs = false;
  for (std::string line : paragraph.text) {
    if (transcript && !line.starts_with("$ ")) continue;
    if (transcript) line.erase(0, 2);
    if (joined.empty() && line.starts_with("    ")) continue;
    const std::size_t comment = comment_at(line);
    // "needs ..." begins a comment, or what is behind a semicolon in it.
    needs |= line.find("# needs ", comment) != std::string::npos ||
             line.find("; needs ", comment) != std::string::npos;
    std::string code = line.substr(0, comment);
    code.erase(code.find_last_not_of(' ') + 1);
    joined += code;
    if (code.ends_with("\\")) {
      joined.back() = ' ';
      continue;
    }
    if (code.ends_with("|") || code.ends_with("&&")) {
      joined += ' ';
      continue;
    }
    if (!joined.empty()) (needs ? out.left_out : out.lines).push_back(joined);
    joined.clear();
    needs = false;
  }
}

inline bool has_command(const Example& example) {
  for (const auto* lines : {&example.lines, &example.left_out}) {
    for (const std::string& line : *lines) {
      if (runs_animeme(line)) return true;
    }
  }
  return false;
}

/// Those of a file. A section is one example; where its first paragraph only makes a folder of
/// samples, each of the others is one, behind it.
inline std::vector<Example> examples_of(const std::string& readme, const std::string& markdown) {
  std::vector<Example> all;
  std::string section = "none yet";
  std::vector<std::string> setup;
  for (const Paragraph& paragraph : paragraphs_of(markdown)) {
    if (paragraph.section != section) setup.clear();
    Example example{readme, paragraph.line, {}, {}};
    add_lines(paragraph, example);
    const bool same = paragraph.section == section && !all.empty();
    section = paragraph.section;
    if (!has_command(example)) {
      const bool samples = example.lines.size() == 1 && example.lines[0].ends_with("cd try");
      if (samples) setup = example.lines;
      continue;
    }
    if (same && setup.empty()) {
      all.back().lines.insert(all.back().lines.end(), example.lines.begin(), example.lines.end());
      all.back().left_out.insert(all.back().left_out.end(), example.left_out.begin(),
                                 example.left_out.end());
      continue;
    }
    example.lines.insert(example.lines.begin(), setup.begin(), setup.end());
    all.push_back(std::move(example));
  }
  return all;
}

}  // namespace animeme::test
