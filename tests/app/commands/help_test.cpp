// What --help prints of every command.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/commands/help_lines.h"

namespace animeme {
namespace help_test {

using test::animeme;
using test::run_command;
using testing::HasSubstr;
using testing::StartsWith;

std::size_t widest(const std::string& text) {
  std::istringstream lines(text);
  std::size_t width = 0;
  for (std::string line; std::getline(lines, line);) width = std::max(width, line.size());
  return width;
}

std::string help_at(const std::string& columns, const std::string& line) {
  const std::string program = test::quoted(std::string(test::kBinaryFolder) + "/bin/animeme");
  return run_command({"sh", "-c", columns + " " + program + " " + line}).out;
}

TEST(Help, FitsIntoEightyColumns) {
  std::vector<std::string> lines = {"--help"};
  for (const std::string& command : test::all_commands()) {
    lines.push_back(command + " --help");
    lines.push_back(command + " --help-all");
  }
  for (const std::string& line : lines) {
    const std::string help = help_at("COLUMNS=", line);
    EXPECT_LE(widest(help), 80u) << line << "\n" << help;
  }
}

TEST(Help, FillsTheColumnsOfTheTerminal) {
  const std::string wide = help_at("COLUMNS=150", "speak --help");
  EXPECT_LE(widest(wide), 150u);
  EXPECT_GT(widest(wide), 100u);
  EXPECT_LE(widest(help_at("COLUMNS=100", "speak --help")), 100u);
  // The words are the same, whatever the width.
  const auto words = [](const std::string& text) {
    std::istringstream in(text.substr(0, text.find("Examples:")));
    std::string all;
    for (std::string word; in >> word;) all += word + " ";
    return all;
  };
  EXPECT_EQ(words(wide), words(help_at("COLUMNS=80", "speak --help")));
}

// Beside its names or, if these are long, below them.
TEST(Help, EveryOptionSaysWhatItDoes) {
  for (const std::string& command : test::all_commands()) {
    const std::vector<std::string> lines = test::help_lines({command, "--help"});
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
      const auto says = [&](std::size_t line) {
        return lines[line].size() > 30 && lines[line][29] == ' ' && lines[line][30] != ' ';
      };
      if (lines[i].starts_with("  -")) {
        EXPECT_TRUE(says(i) || says(i + 1) || says(i + 2)) << command << ": " << lines[i];
      }
    }
  }
}

// What people type before they have read anything.
TEST(Help, IsFoundByAnyName) {
  const std::string all = animeme({"--help"}).out, speak = animeme({"speak", "--help"}).out;
  EXPECT_THAT(all, HasSubstr("Commands:\n  speak "));
  EXPECT_EQ(animeme({"help"}).out, all);
  EXPECT_EQ(animeme({"-h"}).out, all);
  EXPECT_EQ(animeme({"help", "speak"}).out, speak);
  EXPECT_EQ(animeme({"speak", "-h"}).out, speak);
  EXPECT_EQ(animeme({"-q", "speak", "--help"}).out, speak);
  const auto alone = animeme({});
  EXPECT_EQ(alone.err, all);
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_EQ(animeme({"help", "speak"}).exit_code, 0);
}

TEST(Help, VersionIsFoundByAnyName) {
  const std::string version = animeme({"--version"}).out;
  EXPECT_THAT(version, StartsWith("animeme 0."));
  EXPECT_EQ(animeme({"version"}).out, version);
  EXPECT_EQ(animeme({"-V"}).out, version);
  EXPECT_THAT(animeme({"version", "--json"}).out, HasSubstr("\"version\""));
}

TEST(Help, UsageErrorsNameTheHelpToRead) {
  EXPECT_THAT(animeme({"speak"}).err, HasSubstr("\nRun 'animeme speak --help'.\n"));
  EXPECT_THAT(animeme({"-q", "encode", "--quant", "99"}).err,
              HasSubstr("Run 'animeme encode --help'."));
  EXPECT_THAT(animeme({"--nothing"}).err, HasSubstr("\nRun 'animeme --help'.\n"));
}

}  // namespace help_test
}  // namespace animeme
