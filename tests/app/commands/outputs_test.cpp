// Outputs that cannot be written are told before any input is looked at, with the remedy, and
// nothing stays behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <set>

#include "tests/app/commands/help_lines.h"
#include "tests/support/folders.h"

namespace animeme {
namespace unwritable_outputs_test {

namespace fs = std::filesystem;
using test::animeme;
using test::HelpLine;
using test::HelpOfCommand;
using test::TempDir;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

bool is_output(const HelpLine& line) { return line.value == "OUT" || line.value == "OUT/"; }

// A value that passes for now; no input is there.
std::string some_value(const HelpLine& line) {
  if (!line.words.empty()) return line.words.front();
  return line.name == "--to" ? "udp://127.0.0.1:5004" : "no_such_input";
}

bool has_option(const HelpOfCommand& command, const std::string& name) {
  for (const HelpLine& line : command.lines) {
    if (line.name == "--" + name) return true;
  }
  return false;
}

// The command with all that it requires, but for this output.
std::vector<std::string> with_output(const HelpOfCommand& command, const HelpLine& output,
                                     const std::string& path, const std::string& spare) {
  std::vector<std::string> arguments{command.name};
  for (const HelpLine& line : command.lines) {
    if (!line.required || line.name == output.name) continue;
    if (line.argument() && has_option(command, line.name)) continue;  // given by its option
    if (!line.argument()) arguments.push_back(line.name);
    arguments.push_back(is_output(line) ? spare : some_value(line));
  }
  arguments.insert(arguments.end(), {output.name, path});
  return arguments;
}

class Outputs : public testing::Test {
 protected:
  void SetUp() override {
    test::spill(dir_ / "file", "text");
    fs::create_directory(dir_ / "readonly");
    fs::permissions(dir_ / "readonly", fs::perms::owner_read | fs::perms::owner_exec);
  }
  void TearDown() override { fs::permissions(dir_ / "readonly", fs::perms::owner_all); }

  // An ending that fits, as the message about one that does not lists them.
  std::string ending_of(const HelpOfCommand& command, const HelpLine& output) {
    if (output.value == "OUT/") return "";
    const std::string odd = dir_ / "none/a.nope";
    const std::string said = animeme(with_output(command, output, odd, spare(command, output))).err;
    const std::string key = output.name + " must end in ";
    const std::size_t at = said.find(key);
    if (at == std::string::npos) return ".csv";
    const std::size_t from = at + key.size();
    return said.substr(from, said.find_first_of(", ", from) - from);
  }

  // A file for another output that is required.
  std::string spare(const HelpOfCommand& command, const HelpLine& but) {
    for (const HelpLine& line : command.lines) {
      if (line.required && is_output(line) && line.name != but.name) {
        return dir_ / ("spare" + ending_of(command, line));
      }
    }
    return "";
  }

  void refused(const HelpOfCommand& command, const HelpLine& output, const std::string& path,
               const std::string& ending) {
    const auto result = animeme(with_output(command, output, path, spare(command, output)));
    const std::string line = command.name + " " + output.name + " " + path + ending;
    EXPECT_EQ(result.exit_code, 3) << line << "\n" << result.err;
    EXPECT_THAT(result.err, HasSubstr(path)) << line;
    EXPECT_THAT(result.err, Not(HasSubstr("no_such_input"))) << line;
    EXPECT_THAT(result.err, AnyOf(HasSubstr("is there such a folder?"), HasSubstr("give "),
                                  HasSubstr("free some space"), HasSubstr("must be writable"),
                                  HasSubstr("Not a directory")))
        << line;
  }

  const TempDir dir_;
};

TEST_F(Outputs, AreTriedBeforeTheWork) {
  std::set<std::string> silent;
  for (const std::string& name : test::all_commands()) {
    const HelpOfCommand command = test::help_of(name);
    bool writes = false;
    for (const HelpLine& output : command.lines) {
      if (!is_output(output)) continue;
      writes = true;
      const std::string ending = ending_of(command, output);
      const std::string below = dir_ / ("file/a" + ending), system = "/proc/a" + ending,
                        readonly = dir_ / ("readonly/a" + ending);
      refused(command, output, below, "");
      refused(command, output, system, "");
      if (::geteuid() != 0) refused(command, output, readonly, "");
      if (output.value == "OUT/") {
        refused(command, output, dir_ / "file", "");
        continue;
      }
      const std::string folder = dir_ / ("folder" + ending), full = dir_ / ("full" + ending);
      fs::create_directory(folder);
      fs::create_symlink("/dev/full", full);
      if (name != "import" && name != "crossmap" && name != "manual") {  // which write folders, too
        refused(command, output, folder, "");
      }
      refused(command, output, dir_ / ("none/a" + ending), "");
      refused(command, output, full, "");
      fs::remove(folder);
      fs::remove(full);
    }
    if (!writes) silent.insert(name);
  }
  EXPECT_EQ(silent, (std::set<std::string>{"compare", "follow", "info", "serve", "stats"}));
  EXPECT_THAT(dir_.files(), testing::UnorderedElementsAre("file", "readonly"));  // as it was
}

TEST_F(Outputs, StandardOutputIsTriedAndFlushed) {
  const std::string program = test::quoted(std::string(test::kBinaryFolder) + "/bin/animeme");
  for (const char* line :
       {"decode no_such_input -o -", "encode no_such_input -o -", "view no_such_input -o -",
        "manual bash", "--help", "speak --help", "phones --lang en --json"}) {
    const auto result = test::run_command({"sh", "-c", program + " " + line + " >/dev/full"});
    EXPECT_EQ(result.exit_code, 3) << line;
    EXPECT_THAT(result.err, HasSubstr("No space left")) << line;
    EXPECT_THAT(result.err, Not(HasSubstr("no_such_input"))) << line;
  }
}

TEST_F(Outputs, AFolderOfSegmentsThatHoldsOtherFiles) {
  fs::create_directory(dir_ / "talk_hls");
  test::spill(dir_ / "talk_hls/thesis.txt", "mine");
  const auto result = animeme({"mux", "no_such_input", "no_such_input", "-o", dir_ / "talk.m3u8"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("thesis.txt"));
}

// A pipe's reader would take a try for the end.
TEST_F(Outputs, PipesAreNotOpenedTwice) {
  const std::string program = test::quoted(std::string(test::kBinaryFolder) + "/bin/animeme");
  const std::string plain =
      test::quoted(std::string(test::kSourceFolder) + "/tests/data/fap/plain.fap");
  const std::string pipe = test::quoted(dir_ / "pipe");
  const auto result = test::run_command({"sh", "-c",
                                         "mkfifo " + pipe + "; cat " + pipe + " & " + program +
                                             " -q encode " + plain + " -o " + pipe + "; wait"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(result.out.size(), 40u);
}

}  // namespace unwritable_outputs_test
}  // namespace animeme
