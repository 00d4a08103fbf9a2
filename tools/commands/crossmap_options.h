/// @file
/// Options of crossmap, and the project that they make.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/crossmap/run.h"

namespace CLI {
class App;
}  // namespace CLI

namespace animeme::tools {

/// What was said on the command line; it goes before what a project says.
struct CrossmapOptions {
  std::vector<std::string> inputs;  ///< recordings, or a project
  /// --output, --write-keys, --picture
  std::string output, write_keys, picture;
  bool json = false, csv = false;  ///< --json, --csv
  /// Those of these names.
  std::optional<std::string> to, points, neutral, keys, rate, size, layout, axes, unit;
  /// --shapes, --controls, --fapu, --key, --use, --head-points
  std::vector<std::string> shapes, controls, fapu, named, use, head;
  std::optional<std::size_t> count;                          ///< --shapes-wanted
  std::optional<double> preference, smooth, contact_weight;  ///< those of these names
  bool convex = false;                                       ///< --convex
};

/// The project that a file and options say. Errors: those of reading it.
Result<crossmap::Project> project_of(const CrossmapOptions& options);

/// Adds them.
void add_options(CLI::App& app, CrossmapOptions& options);

/// Runs the command with them.
Result<int> run(const CrossmapOptions& options);

}  // namespace animeme::tools
