// --json of every command: what a script reads when something went wrong, and what was written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/commands/help_lines.h"
#include "tests/support/folders.h"

namespace animeme {
namespace json_test {

using nlohmann::json;
using test::animeme;
using test::HelpLine;
using test::HelpOfCommand;
using test::TempDir;
using testing::HasSubstr;

// "--json", with a place where it takes one.
std::vector<std::string> asking_for_json(const HelpOfCommand& help) {
  for (const HelpLine& line : help.lines) {
    if (line.name == "--json") return {"--json", "-"};
  }
  return {"--json"};
}

json error_of(const test::ProgramResult& result, const std::string& line) {
  const json all = json::parse(result.out, nullptr, false);
  EXPECT_TRUE(all.is_object() && all.contains("error") && all.size() == 1)
      << line << "\n"
      << result.out << result.err;
  return all.is_object() ? all.value("error", json::object()) : json::object();
}

TEST(Json, EveryCommandHasIt) {
  for (const std::string& command : test::all_commands()) {
    EXPECT_THAT(animeme({command, "--help"}).out, HasSubstr("\n  --json ")) << command;
  }
}

TEST(Json, UsageErrorsOfEveryCommand) {
  for (const std::string& command : test::all_commands()) {
    std::vector<std::string> line = {command};
    for (const std::string& word : asking_for_json(test::help_of(command))) line.push_back(word);
    line.push_back("--frobnicate");
    const auto result = animeme(line);
    EXPECT_EQ(result.exit_code, 2) << command;
    const json error = error_of(result, command);
    EXPECT_EQ(error.value("code", ""), "usage") << command;
    EXPECT_THAT(error.value("message", ""), HasSubstr("has no option --frobnicate")) << command;
    EXPECT_THAT(result.err, HasSubstr(error.value("message", "?"))) << command;
  }
}

// All that a command requires, with inputs that do not exist.
std::vector<std::string> without_inputs(const HelpOfCommand& help, const TempDir& dir) {
  std::vector<std::string> line = {help.name};
  for (const HelpLine& one : help.lines) {
    const bool output = one.value == "OUT" || one.value == "OUT/";
    const bool wanted = one.required || (output && one.name == "--output");
    if (!wanted || (one.argument() && help.name == "align")) continue;
    if (!one.argument()) line.push_back(one.name);
    const std::string ending = help.name == "encode" || help.name == "speak"  ? ".fba"
                               : help.name == "view"                          ? ".html"
                               : help.name == "plot" || help.name == "render" ? ".png"
                               : help.name == "train"                         ? ".dam"
                               : help.name == "align"                         ? ".TextGrid"
                               : help.name == "mux"                           ? ".mp4"
                               : help.name == "demux"                         ? ".fba"
                                                                              : ".csv";
    line.push_back(output               ? dir / ("out" + (one.value == "OUT/" ? "" : ending))
                   : !one.words.empty() ? one.words.front()
                   : one.name == "--to" ? "udp://127.0.0.1:5004"
                                        : dir / "none.fap");
  }
  if (help.name == "speak") line.insert(line.end(), {"--script", dir / "none.TextGrid"});
  if (help.name == "evaluate" || help.name == "stream") line.push_back(dir / "none.fap");
  if (help.name == "receive")
    line[1] = dir / "none.sdp", line.insert(line.end(), {"--wait", "0.2"});
  if (help.name == "follow") line.insert(line.end(), {"--audio", dir / "none.wav"});
  if (help.name == "serve") line.push_back(dir / "none.json");
  if (help.name == "phones") line.insert(line.end(), {"--lang", "nowhere"});
  if (help.name == "manual") line = {"manual", "bash", "-o", dir / "none/bash"};
  if (help.name == "decode" || help.name == "head") line.back() = dir / "out.fap";
  if (help.name == "head") line = {"head", dir / "none.glb"};
  for (const std::string& word : asking_for_json(help)) line.push_back(word);
  return line;
}

TEST(Json, BadInputOfEveryCommand) {
  const TempDir dir;
  for (const std::string& command : test::all_commands()) {
    const std::vector<std::string> line = without_inputs(test::help_of(command), dir);
    const auto result = animeme(line);
    const std::string all = testing::PrintToString(line);
    EXPECT_THAT(result.exit_code, testing::AnyOf(2, 3)) << all;
    const json error = error_of(result, all);
    EXPECT_FALSE(error.value("message", "").empty()) << all;
    EXPECT_EQ(error.value("code", "") == "usage", result.exit_code == 2) << all << error;
  }
}

TEST(Json, ErrorsTellWhere) {
  const TempDir dir;
  test::spill(dir / "bad.fap", "2.1 C:\\bad 25 2\nnonsense\n");
  const json error =
      error_of(animeme({"encode", dir / "bad.fap", "-o", dir / "bad.fba", "--json"}), "encode");
  EXPECT_EQ(error.value("file", ""), dir / "bad.fap");
  EXPECT_GT(error.value("position", json::object()).value("line", 0), 0);
  EXPECT_EQ(error.value("code", ""), "syntax");
}

// The commands that print nothing else.
TEST(Json, WhatWasWritten) {
  const TempDir dir;
  const std::string plain = std::string(test::kSourceFolder) + "/tests/data/fap/plain.fap";
  const auto report = [&](const std::vector<std::string>& line) {
    const auto result = animeme(line);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json all = json::parse(result.out, nullptr, false);
    EXPECT_TRUE(all.is_object() && all["outputs"].is_array() && all["warnings"].is_array())
        << result.out;
    return all.is_object() && !all["outputs"].empty() ? all["outputs"][0] : json::object();
  };
  ASSERT_EQ(animeme({"encode", plain, "-o", dir / "a.fba"}).exit_code, 0);
  const json decoded = report({"decode", dir / "a.fba", "-o", dir / "a.fap", "--json"});
  EXPECT_EQ(decoded.value("output", ""), dir / "a.fap");
  EXPECT_GT(decoded.value("frames", 0), 1);
  EXPECT_GT(report({"view", plain, "-o", dir / "a.html", "--json"}).value("bytes", 0), 1000);
  EXPECT_GT(report({"plot", plain, "-o", dir / "a.svg", "--json"}).value("rows", 0), 0);
  EXPECT_EQ(
      report({"render", plain, "--frame", "1", "--size", "32x32", "-o", dir / "a.png", "--json"})
          .value("pictures", 0),
      1);
  EXPECT_GT(report({"export", plain, "-o", dir / "a.csv", "--json"}).value("frames", 0), 1);
  EXPECT_GT(report({"import", dir / "a.csv", "-o", dir / "b.fap", "--json"}).value("faps", 0), 1);
  EXPECT_EQ(report({"manual", "bash", "-o", dir / "bash", "--json"}).value("files", 0), 1);

  const auto poses = animeme({"retarget", "builtin", "--save-poses", dir / "poses.csv", "--json"});
  EXPECT_FALSE(json::parse(poses.out, nullptr, false).value("controls", json()).empty());

  const auto followed = animeme({"follow", "--json"}, "0 0.3 SIL\n0.3 0.42 HH\n0.42 0.6 AY\n");
  std::istringstream rows(followed.out);
  int frames = 0;
  for (std::string row; std::getline(rows, row); ++frames) {
    const json one = json::parse(row, nullptr, false);
    EXPECT_NEAR(one.value("time_s", -1.0), frames / 25.0, 1e-9);
    EXPECT_TRUE(one["controls"].contains("fap3_open_jaw")) << row;
  }
  EXPECT_GT(frames, 10);
}

// One place, one kind of data.
TEST(Json, IsNotMixedWithData) {
  const std::string plain = std::string(test::kSourceFolder) + "/tests/data/fap/plain.fap";
  for (const std::vector<std::string>& line : std::vector<std::vector<std::string>>{
           {"decode", plain, "-o", "-", "--json"}, {"manual", "bash", "--json"}}) {
    const auto result = animeme(line);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(error_of(result, line[0]).value("message", ""), HasSubstr("standard output"));
  }
}

}  // namespace json_test
}  // namespace animeme
