/// @file
/// A command of the program: its name, its options, what it runs and how it ends.
#pragma once

#include <memory>
#include <string>

#include "fap/result.h"
#include "tools/app/commands/options.h"
#include "tools/formats/common/exit_code.h"

namespace animeme::tools {

struct OptionTable;

/// What runs when a command was chosen: its options, which the command line has set, and a
/// function that takes them. It returns the exit code, or an error that main() prints (exit code
/// 3).
struct Action {
  std::shared_ptr<void> options;                ///< of the type that `run` expects
  Result<int> (*run)(void* options) = nullptr;  ///< runs the command with them
};

/// Command::add: creates the options, adds them by add_options(cli, options), and runs
/// run(options). Both functions stand beside the command.
template <class Options>
Action set_up(OptionTable& cli) {
  const auto options = std::make_shared<Options>();
  add_options(cli, *options);
  return {options, [](void* parsed) { return run(*static_cast<Options*>(parsed)); }};
}

/// One command: its name, one line of help, and the function that sets it up. `examples` ends
/// its --help.
struct Command {
  const char* name;                 ///< as typed
  const char* summary;              ///< one line of --help
  const char* examples;             ///< of use, lines with two blanks in front
  Action (*add)(OptionTable& cli);  ///< set_up<Options>
};

/// @{
/// The commands of the program, one file each.
extern const Command kAlign, kBatch, kCheck, kCompare, kCorpus, kCrossmap, kDecode, kDemux, kDub,
    kEdit, kEncode, kEvaluate, kExport, kFollow, kHead, kImport, kInfo, kManual, kMux, kPhones,
    kPlot, kReceive, kRender, kRetarget, kServe, kSpeak, kStats, kStream, kTrain, kView;
/// @}

/// Prints a usage error on standard error, and which help to read; returns kUsage for the command
/// to return.
int usage_error(const std::string& text);

}  // namespace animeme::tools
