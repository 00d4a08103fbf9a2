/// @file
/// Options of receive.
#pragma once

#include <string>
#include <vector>

#include "tools/live/sessions/address.h"
#include "tools/live/sessions/receive_output.h"

namespace animeme::tools {

struct OptionTable;

/// What was said on the command line.
struct ReceiveOptions {
  std::string source;            ///< address or session description
  std::string output;            ///< -o; empty: what comes is sent on, and nothing else
  std::vector<std::string> to;   ///< --to
  std::vector<std::string> sdp;  ///< --sdp
  live::SourceOptions receive;   ///< --reorder-seconds ...
  bool any_source = false;       ///< --any-source
  std::string gap = "hold";      ///< --gap
  double duration = 0;           ///< --duration, seconds
  double wait = 60;              ///< --wait, seconds
  double timeout = 10;           ///< --timeout, seconds
  live::FapOutputOptions text;   ///< --coded, --fill, --expand, --exact
  bool stats = false;            ///< --stats
  bool json = false;             ///< --json
};

/// Adds them.
void add_options(OptionTable& cli, ReceiveOptions& options);

/// Runs the command with them.
Result<int> run(ReceiveOptions& options);

}  // namespace animeme::tools
