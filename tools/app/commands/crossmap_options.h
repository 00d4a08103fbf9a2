/// @file
/// Options of crossmap, and the project that they make.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/characters/crossmap/run.h"

namespace animeme::tools {

struct OptionTable;

/// What was said on the command line; it goes before what a project says.
struct CrossmapOptions {
  std::vector<std::string> inputs;       ///< recordings, or a project
  std::string output;                    ///< --output
  std::string write_keys;                ///< --write-keys
  std::string picture;                   ///< --picture
  bool json = false;                     ///< --json
  bool csv = false;                      ///< --csv
  std::optional<std::string> to;         ///< --to
  std::optional<std::string> points;     ///< --points
  std::optional<std::string> neutral;    ///< --neutral
  std::optional<std::string> keys;       ///< --keys
  std::optional<std::string> rate;       ///< --rate
  std::optional<std::string> size;       ///< --size
  std::optional<std::string> layout;     ///< --layout
  std::optional<std::string> axes;       ///< --axes
  std::optional<std::string> unit;       ///< --unit
  std::vector<std::string> shapes;       ///< --shapes
  std::vector<std::string> controls;     ///< --controls
  std::vector<std::string> fapu;         ///< --fapu
  std::vector<std::string> named;        ///< --key
  std::vector<std::string> use;          ///< --use
  std::vector<std::string> head;         ///< --head-points
  std::optional<std::size_t> count;      ///< --shapes-wanted
  std::optional<double> preference;      ///< --preference
  std::optional<double> smooth;          ///< --smooth
  std::optional<double> contact_weight;  ///< --contact-weight
  bool convex = false;                   ///< --convex
};

/// The project that a file and options say. Errors: those of reading it.
Result<crossmap::Project> project_of(const CrossmapOptions& options);

/// Adds them.
void add_options(OptionTable& cli, CrossmapOptions& options);

/// Runs the command with them.
Result<int> run(const CrossmapOptions& options);

}  // namespace animeme::tools
