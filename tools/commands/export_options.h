/// @file
/// Options of export.
#pragma once

#include <string>
#include <vector>

#include "tools/commands/common.h"
#include "tools/exchange/visemes.h"
#include "tools/studio/head_file.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace animeme::tools {

/// What was said on the command line.
struct ExportOptions {
  std::string input;
  std::string output;
  std::string audio;
  std::string what;
  std::string script;
  speech::ScriptInput reading;
  std::string rate = "25";
  std::string format;  // of Rhubarb
  std::string dialog_file;
  exchange::RhubarbOptions rhubarb;
  LengthLimit length;
  double crossfade = 0.08;
  studio::HeadChoice head;
  std::string morphs = "arkit";
  bool normals = false;
  std::vector<std::string> more;  // inputs, for a head of the user's own
  std::vector<std::string> sounds;
  std::vector<const CLI::Option*> of_scripts;  // options that are for visemes of scripts alone
  std::vector<const CLI::Option*> of_heads;    // for .glb alone
};

/// Adds them.
void add_options(CLI::App& app, ExportOptions& options);

/// Runs the command with them.
Result<int> run(const ExportOptions& options);

}  // namespace animeme::tools
