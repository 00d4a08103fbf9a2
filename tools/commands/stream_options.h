/// @file
/// Options of stream.
#pragma once

#include <string>
#include <vector>

#include "tools/live/address.h"
#include "tools/live/program.h"

namespace CLI {
class App;
}  // namespace CLI

namespace animeme::tools {

/// What was said on the command line.
struct StreamOptions {
  std::string input;
  std::vector<std::string> to;
  std::vector<std::string> sdp;
  live::SinkOptions sink;
  live::ProgramOptions program;
  std::string codec;
  std::string rate = "25";
  std::string pcm;
  bool no_sound = false;
  bool fast = false;
  bool stats = false;
  bool json = false;
};

/// Adds them.
void add_options(CLI::App& app, StreamOptions& options);

/// Runs the command with them.
Result<int> run(StreamOptions& options);

}  // namespace animeme::tools
