/// @file
/// Options of serve.
#pragma once

#include <string>
#include <vector>

#include "tools/live/serve/server.h"

namespace animeme::tools {

struct OptionTable;

/// What was said on the command line.
struct ServeOptions {
  std::string heads;                ///< file with heads that are there from the beginning
  std::string token_file;           ///< --token-file
  std::vector<std::string> models;  ///< --model, NAME=FILE
  serve::ServerOptions server;      ///< all others
  bool stats = false;               ///< --stats
  bool json = false;                ///< --json
};

/// Adds them.
void add_options(OptionTable& cli, ServeOptions& options);

/// Runs the command with them.
Result<int> run(ServeOptions& options);

}  // namespace animeme::tools
