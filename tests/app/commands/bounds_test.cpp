// Values that no option can mean end in 2 with the option's name, before anything else is looked
// at: no command is given an input here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/app/commands/help_lines.h"
#include "tests/support/folders.h"

namespace animeme {
namespace bounds_test {

using test::animeme;
using test::HelpLine;
using testing::HasSubstr;

// What may be any text, or is looked for on the disk.
bool takes_any_text(const HelpLine& line) {
  static const std::set<std::string> kinds = {"TEXT", "FILE",    "NAME", "OUT",
                                              "OUT/", "COMMAND", "LANG", "COLUMN"};
  return kinds.contains(line.value);
}

struct Try {
  std::string option, value;
};

// What the program answers to each, by one shell: "2 --rate: ..." a line.
std::vector<std::string> answers(const std::string& command, const std::vector<Try>& tries) {
  const std::string program = test::quoted(std::string(test::kBinaryFolder) + "/bin/animeme");
  std::string script;
  for (const Try& one : tries) {
    script += "said=$(" + program + " " + command + " " + one.option + " " +
              test::quoted(one.value) + " 2>&1); echo $? $said\n";
  }
  std::istringstream text(test::run_command({"sh", "-c", script}).out);
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST(Bounds, EveryValueIsChecked) {
  std::size_t options = 0;
  for (const std::string& command : test::all_commands()) {
    std::vector<Try> tries;
    for (const HelpLine& line : test::help_of(command).lines) {
      if (line.argument() || takes_any_text(line)) continue;
      ++options;
      for (const char* value : {"", "nan", "-1e30", "9999999999999999999999"}) {
        // No extended shapes at all, as Rhubarb has it.
        if (line.value == "SHAPES" && std::string(value).empty()) continue;
        tries.push_back({line.name, value});
      }
    }
    if (tries.empty()) continue;
    const std::vector<std::string> said = answers(command, tries);
    ASSERT_EQ(said.size(), tries.size()) << command;
    for (std::size_t i = 0; i < tries.size(); ++i) {
      EXPECT_THAT(said[i], testing::AllOf(testing::StartsWith("2 "), HasSubstr(tries[i].option)))
          << command << " " << tries[i].option << " '" << tries[i].value << "'";
    }
  }
  EXPECT_GT(options, 120u);
}

// Numbers do not hide among texts.
TEST(Bounds, NumbersAreNoTexts) {
  const std::set<std::string> numbers = {
      "--rate",        "--size",       "--sheet",      "--time",     "--view",    "--gain",
      "--quant",       "--seed",       "--pcm",        "--duration", "--shard",   "--pixel-aspect",
      "--depth-scale", "--lag",        "--confidence", "--fapu",     "--key",     "--faps",
      "--curves",      "--preference", "--zoom",       "--jobs",     "--timeout", "--max-rms",
      "--closed-gap",  "--folds",      "--draws",      "--delay"};
  std::set<std::string> seen;
  for (const std::string& command : test::all_commands()) {
    for (const HelpLine& line : test::help_of(command).lines) {
      if (!numbers.contains(line.name)) continue;
      if (line.value == "OUT") continue;  // phones --sheet, a file
      seen.insert(line.name);
      EXPECT_FALSE(takes_any_text(line)) << command << " " << line.name << " " << line.value;
    }
  }
  EXPECT_EQ(seen, numbers);
}

// Beside the ends of what is allowed.
TEST(Bounds, JustOutsideIsOutside) {
  const std::vector<std::vector<std::string>> lines = {{"encode", "--quant", "32"},
                                                       {"encode", "--quant", "-1"},
                                                       {"encode", "--quant", "1.5"},
                                                       {"render", "--size", "0x64"},
                                                       {"render", "--size", "8193x64"},
                                                       {"render", "--sheet", "21x20"},
                                                       {"render", "--time", "1,-1"},
                                                       {"render", "--gain", "0.2"},
                                                       {"render", "--view", "361"},
                                                       {"train", "--shard", "5/4"},
                                                       {"batch", "--shard", "0/4"},
                                                       {"stream", "--pcm", "16000:0"},
                                                       {"import", "--depth-scale", "0"},
                                                       {"import", "--confidence", "1.1"},
                                                       {"crossmap", "--fapu", "MW=0"},
                                                       {"crossmap", "--key", "M=take.csv:-1"},
                                                       {"crossmap", "--preference", "0.1"},
                                                       {"plot", "--faps", "3,69"},
                                                       {"speak", "--rate", "0"},
                                                       {"speak", "--rate", "-25"},
                                                       {"edit", "--rate", "1000000"},
                                                       {"decode", "--rate", "1001"},
                                                       {"render", "--rate", "1/1000"},
                                                       {"export", "--rate", "9999999999"},
                                                       {"train", "--lag", "1001"}};
  for (const std::vector<std::string>& line : lines) {
    const auto result = animeme(line);
    EXPECT_EQ(result.exit_code, 2) << line[0] << " " << line[1] << " " << line[2];
    EXPECT_THAT(result.err, HasSubstr(line[1])) << line[0] << " " << line[2];
  }
}

}  // namespace bounds_test
}  // namespace animeme
