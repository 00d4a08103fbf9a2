/// @file
/// Options of export.
#pragma once

#include <string>
#include <vector>

#include "tools/app/commands/common.h"
#include "tools/formats/exchange/visemes.h"
#include "tools/view/studio/head_file.h"

namespace animeme::tools {

/// What was said on the command line.
struct ExportOptions {
  std::string track;                      ///< --track
  std::string input;                      ///< the clip
  std::string output;                     ///< --output
  std::string audio;                      ///< --audio
  std::string what;                       ///< --what
  std::string script;                     ///< --script
  std::string mouth = "visemes";          ///< --mouth; see said_visemes.h
  speech::ScriptInput reading;            ///< --tier, --speaker, --script-format ...
  std::string rate = "25";                ///< --rate
  std::string format;                     ///< --format, of Rhubarb
  std::string dialog_file;                ///< --dialog-file
  exchange::RhubarbOptions rhubarb;       ///< --extended-shapes, --dat-rate, --preston-blair
  LengthLimit length;                     ///< --max-seconds
  double crossfade = 0.08;                ///< --crossfade
  studio::HeadChoice head;                ///< --head, --points, --gain
  std::string morphs = "arkit";           ///< --morphs
  bool normals = false;                   ///< --normals
  std::vector<std::string> more;          ///< further clips, for a head of the user's own
  std::vector<std::string> sounds;        ///< --sound
  std::vector<const Option*> of_scripts;  ///< options that are for visemes of scripts alone
  std::vector<const Option*> of_heads;    ///< for .glb alone
};

/// Adds them.
void add_options(OptionTable& cli, ExportOptions& options);

/// Runs the command with them.
Result<int> run(const ExportOptions& options);

}  // namespace animeme::tools
