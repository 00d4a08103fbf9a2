// Runs the animeme program as a user does: arguments in, exit code and output back.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "tests/support/files.h"
#include "tests/support/folders.h"
#include "tests/support/temp_dir.h"

namespace animeme::test {

struct ProgramResult {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out;
  std::string err;
};

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
  arguments.insert(arguments.begin(), std::string(test::kBinaryFolder) + "/bin/animeme");
  return run_command(arguments, input);
}

/// Output of a shell command; `status` receives what system() would return.
inline std::string run(const std::string& command, int* status = nullptr) {
  std::string output;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 65536> block{};
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), pipe)) {
    output.append(block.data(), got);
  }
  const int result = pclose(pipe);
  if (status != nullptr) *status = result;
  return output;
}

/// True if a program is installed.
inline bool has_program(const std::string& name) {
  return std::system(("command -v " + quoted(name) + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace animeme::test
