/// @file
/// A command of the program: its name, its options, what it runs and how it ends.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fap/result.h"
#include "tools/app/commands/outputs.h"
#include "tools/formats/common/exit_code.h"

namespace CLI {
class App;
}

namespace animeme::tools {

/// A command puts its options into `app` and returns what is to run when it was chosen: the exit
/// code, or an error that main() prints (exit code 3).
using Action = std::function<Result<int>()>;

/// Command::add of most: makes the options, adds them by add_options(app, options), and runs
/// run(options). Both functions stand beside the command.
template <class Options>
Action set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  add_options(app, *options);
  return [options] { return run(*options); };
}

/// One command: its name, one line of help, and the function that sets it up. `examples` ends
/// its --help.
struct Command {
  const char* name;              ///< as typed
  const char* summary;           ///< one line of --help
  const char* examples;          ///< of use, lines with two blanks in front
  Action (*add)(CLI::App& app);  ///< sets options up; what it returns is run
};

/// @{
/// The commands of the program, one file each.
extern const Command kAlign, kBatch, kCheck, kCompare, kCorpus, kCrossmap, kDecode, kDemux, kEncode,
    kEvaluate, kExport, kFollow, kHead, kImport, kInfo, kManual, kMux, kPhones, kPlot, kReceive,
    kRender, kRetarget, kServe, kSpeak, kStats, kStream, kTrain, kView;
/// @}

/// Prints a usage error on standard error; returns kUsage for the command to return.
int usage_error(const std::string& text);

}  // namespace animeme::tools
