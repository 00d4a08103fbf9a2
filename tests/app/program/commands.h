// Commands that have to succeed, and what they say.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fap/text.h"
#include "tests/support/program.h"

namespace animeme::test {

using Json = nlohmann::json;

inline void succeeds(const std::vector<std::string>& arguments) {
  const auto result = animeme(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

/// What the program says with --json.
inline Json json_of(std::vector<std::string> arguments, int exit_code = 0) {
  arguments.push_back("--json");
  const auto result = animeme(arguments);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  return Json::parse(result.out, nullptr, false);
}

inline fap::Sequence read_clip(const std::string& path) {
  auto clip = fap::read_text(slurp(path));
  EXPECT_TRUE(clip) << clip.error().describe();
  return clip ? *clip : fap::Sequence{};
}

// What stands between ```sh and ```.
inline std::string fenced_commands(const std::string& text) {
  std::string commands;
  std::size_t at = 0;
  while ((at = text.find("\n```sh\n", at)) != std::string::npos) {
    at += 7;
    const std::size_t end = text.find("\n```", at);
    commands += text.substr(at, end + 1 - at);
    at = end + 4;
  }
  return commands;
}

}  // namespace animeme::test
