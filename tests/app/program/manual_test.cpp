// Man pages and completions, as man and the shells themselves read them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "tests/support/program.h"

namespace animeme {
namespace manual_test {

using test::animeme;
using test::run_command;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

// The first words of lines that are indented by two: commands, or options without their values.
std::vector<std::string> listed(const std::string& help) {
  std::vector<std::string> names;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 3 || !line.starts_with("  ") || line[2] == ' ') continue;
    const std::string word = line.substr(2, line.find_first_of(" :{", 2) - 2);
    std::istringstream parts(word);
    for (std::string part; std::getline(parts, part, ',');) names.push_back(part);
  }
  return names;
}

std::vector<std::string> commands() {
  const std::string help = animeme({"--help"}).out;
  std::vector<std::string> names = listed(help.substr(help.find("Commands:")));
  return names;
}

// Whether `lines` has a line that is `line`, or begins with it and a tab.
bool has_line(const std::string& lines, const std::string& line) {
  const std::string text = "\n" + lines;
  return text.find("\n" + line + "\n") != std::string::npos ||
         text.find("\n" + line + "\t") != std::string::npos;
}

class Manual : public testing::Test {
 protected:
  std::string file(const std::string& form) {
    const std::string path = dir_ / form;
    const auto result = animeme({"manual", form, "-o", path});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return path;
  }

  // What bash offers behind these words.
  std::string offered(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) list += " " + test::quoted(word);
    return run_command({"bash", "--norc", "-c",
                        "source " + test::quoted(file("bash")) + "; COMP_WORDS=(animeme" + list +
                            "); COMP_CWORD=" + std::to_string(words.size()) +
                            "; $(complete -p animeme | sed 's/.*-F \\([^ ]*\\).*/\\1/'); "
                            "printf '%s\\n' \"${COMPREPLY[@]}\""})
        .out;
  }

  const test::TempDir dir_;
};

TEST_F(Manual, EveryCommandHasAPageWithItsOptions) {
  const std::string folder = file("man");
  const std::vector<std::string> names = commands();
  ASSERT_GT(names.size(), 20u);
  for (const std::string& name : names) {
    const std::string path = folder + "/animeme-" + name + ".1";
    ASSERT_TRUE(fs::exists(path)) << name;
    const std::string page = test::slurp(path);
    for (std::string option : listed(animeme({name, "--help"}).out)) {
      if (!option.starts_with("-")) continue;
      std::string as_typed;
      for (const char c : option) as_typed += c == '-' ? "\\-" : std::string(1, c);
      EXPECT_THAT(page, HasSubstr("\\fB" + as_typed + "\\fR")) << name;
    }
  }
}

TEST_F(Manual, ManShowsThePages) {
  if (run_command({"man", "--version"}).exit_code != 0) GTEST_SKIP() << "man-db is not installed";
  for (const auto& page : fs::directory_iterator(file("man"))) {
    const auto shown = run_command({"man", "--warnings", "-E", "UTF-8", "-l", page.path()});
    EXPECT_EQ(shown.exit_code, 0) << page.path();
    EXPECT_EQ(shown.err, "") << page.path();
    EXPECT_THAT(shown.out, HasSubstr("animeme"));
  }
  // What is in the tables comes out as it is.
  const auto shown = run_command(
      {"env", "MANWIDTH=300", "man", "-E", "UTF-8", "-l", file("man") + "/animeme-stream.1"});
  EXPECT_THAT(shown.out, HasSubstr("animeme stream talk.mp4"));
  EXPECT_THAT(shown.out, HasSubstr("--say"));
}

TEST_F(Manual, BashCompletes) {
  EXPECT_EQ(offered({"sp"}), "speak\n");
  EXPECT_EQ(offered({"speak", "--transc"}), "--transcript\n");
  EXPECT_EQ(offered({"-q", "exp"}), "export\n");
  EXPECT_EQ(offered({"manual", "--outp"}), "--output\n");
  EXPECT_EQ(offered({"receive", "--gap", "ne"}), "neutral\n");
  EXPECT_EQ(offered({"render", "talk"}), "\n");  // files are the shell's own work
}

TEST_F(Manual, FishCompletes) {
  if (run_command({"fish", "--version"}).exit_code != 0) GTEST_SKIP() << "fish is not installed";
  const std::string script = file("fish");
  const auto completes = [&](const std::string& line) {
    return run_command({"fish", "--no-config", "-c",
                        "source " + script + "; complete -C " + test::quoted(line)})
        .out;
  };
  EXPECT_TRUE(has_line(completes("animeme sp"), "speak"));
  EXPECT_TRUE(has_line(completes("animeme speak --transc"), "--transcript"));
  EXPECT_TRUE(has_line(completes("animeme receive --gap ne"), "neutral"));
  EXPECT_FALSE(has_line(completes("animeme render --transc"), "--transcript"));
}

// In a terminal, by the tabulator.
TEST_F(Manual, ZshCompletes) {
  if (run_command({"zsh", "--version"}).exit_code != 0) GTEST_SKIP() << "zsh is not installed";
  fs::create_directory(dir_ / "functions");
  fs::copy_file(file("zsh"), (dir_ / "functions") + "/_animeme");
  test::spill(dir_ / "type.zsh",
              "zmodload zsh/zpty\n"
              "zpty z zsh -f -i\n"
              "zpty -w z 'fpath=(" +
                  (dir_ / "functions") +
                  " $fpath); autoload -U compinit; compinit -u -D; print rea\"\"dy'\n"
                  "zpty -r -m z out '*ready*'\n"
                  "zpty -w -n z $'animeme spe\\t'\n"
                  "zpty -r -m z out '*animeme speak*' && print -- completed\n"
                  "zpty -d z\n");
  EXPECT_THAT(run_command({"timeout", "30", "zsh", "-f", dir_ / "type.zsh"}).out,
              HasSubstr("completed"));
}

TEST_F(Manual, Errors) {
  EXPECT_EQ(animeme({"manual", "man"}).exit_code, 2);
  EXPECT_EQ(animeme({"manual", "tcsh"}).exit_code, 2);
  EXPECT_EQ(animeme({"manual", "bash", "-o", "/nowhere/at/all"}).exit_code, 3);
  EXPECT_EQ(animeme({"manual", "man", "-o", "/proc/nowhere"}).exit_code, 3);
  EXPECT_THAT(animeme({"manual", "zsh"}).out, HasSubstr("#compdef animeme"));
}

}  // namespace manual_test
}  // namespace animeme
