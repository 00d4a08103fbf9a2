// Runs the animeme program as a user does: arguments in, exit code and output back.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/support/temp_dir.h"

namespace animeme::test {

struct ProgramResult {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out;
  std::string err;
};

inline std::string slurp(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void spill(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// Any program of the PATH, or with a full path.
inline ProgramResult run_command(const std::vector<std::string>& arguments,
                                 const std::string& input = {}) {
  const TempDir dir;
  spill(dir / "in", input);
  std::string command;
  for (const std::string& argument : arguments) command += quoted(argument) + " ";
  command += "<" + quoted(dir / "in") + " >" + quoted(dir / "out") + " 2>" + quoted(dir / "err");
  const int status = std::system(command.c_str());
  ProgramResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.out = slurp(dir / "out");
  result.err = slurp(dir / "err");
  return result;
}

inline ProgramResult animeme(std::vector<std::string> arguments, const std::string& input = {}) {
  arguments.insert(arguments.begin(), std::string(ANIMEME_BINARY_DIR) + "/bin/animeme");
  return run_command(arguments, input);
}

/// True if a program is installed.
inline bool have(const std::string& program) {
  return std::system(("command -v " + quoted(program) + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace animeme::test
