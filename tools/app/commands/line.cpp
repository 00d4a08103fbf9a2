#include "tools/app/commands/line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "tools/app/commands/common.h"
#include "tools/app/commands/did_you_mean.h"
#include "tools/app/commands/licences.h"
#include "tools/app/commands/outputs.h"

namespace animeme::tools {

namespace {

// Errors of the user's input and errors of ours have different exit codes.
int report_error(const Error& error) {
  // In one piece, as other processes may write to the same place.
  std::cerr << "animeme: error: " + error.describe() + "\n";
  return error.code == Code::internal ? kInternal : kBadInput;
}

constexpr const Command* kCommands[] = {
    &kSpeak,    &kBatch,  &kFollow, &kAlign,  &kCorpus,  &kTrain,   &kEvaluate,
    &kEncode,   &kDecode, &kMux,    &kDemux,  &kInfo,    &kCompare, &kCheck,
    &kStats,    &kPlot,   &kView,   &kRender, &kHead,    &kImport,  &kCrossmap,
    &kRetarget, &kExport, &kStream, &kServe,  &kReceive, &kPhones,  &kManual};

// Common options, and where they go.
struct CommonFlags {
  bool quiet = false;
  bool verbose = false;
};

void set_up_common(CLI::App& app, CommonFlags& flags) {
  app.description(
      "Animeme: speech to MPEG-4 facial animation.\n"
      "Makes faces talk (FAPs), codes them (FBA, a few kbit/s) and muxes them with the voice.");
  app.name("animeme");
  app.require_subcommand(1);
  // --json is an option of commands; here it is one word that is left over.
  const auto version = [&app] {
    const std::vector<std::string> left = app.remaining();
    return version_text(app.count("--verbose") > 0,
                        std::count(left.begin(), left.end(), "--json") > 0);
  };
  app.set_version_flag("--version", version,
                       "The version; with --verbose (and --json) libraries and licences, too");
  app.footer(
      "'animeme COMMAND --help' explains a command.\n"
      "Exit codes: 0 ok, 1 a check failed or a recording ended early, 2 usage, 3 bad input, 4\n"
      "internal error, 130 stopped by Ctrl-C (what was written so far is complete).");
  app.add_flag("-q,--quiet", flags.quiet, "No talk on standard error but errors");
  app.add_flag("-v,--verbose", flags.verbose,
               "More talk: which sounds a model lacks, and what is said");
  app.fallthrough();
}

void add(CLI::App& app, const Command& command, Action& chosen) {
  CLI::App* sub = app.add_subcommand(command.name, command.summary);
  sub->footer(std::string("Examples:\n") + command.examples);
  Action action = command.add(*sub);
  sub->callback([&chosen, action] { chosen = action; });
}

}  // namespace

void set_up_program(CLI::App& app) {
  static CommonFlags flags;  // nothing is parsed
  static Action chosen;
  set_up_common(app, flags);
  for (const Command* command : kCommands) add(app, *command, chosen);
}

int run_line(std::span<const char* const> arguments) {
  CLI::App app;
  CommonFlags flags;
  set_up_common(app, flags);
  Action chosen;
  // A line that begins with its command wants no other: batches run many.
  const std::string first = arguments.size() > 1 ? arguments[1] : "";
  const bool known = std::any_of(std::begin(kCommands), std::end(kCommands),
                                 [&](const Command* one) { return first == one->name; });
  forget_outputs();
  for (const Command* command : kCommands) {
    if (!known || first == command->name) add(app, *command, chosen);
  }
  try {
    app.parse(int(arguments.size()), arguments.data());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      const std::string guess = did_you_mean(app, arguments.subspan(1));
      return usage_error(guess.empty() ? error.what() : guess);
    }
    app.exit(error);  // help
    return kOk;
  }
  set_quiet(flags.quiet);
  set_verbose(flags.verbose);
  for (const CLI::App* command : app.get_subcommands()) {
    if (const std::string text = problem_with_outputs(*command); !text.empty()) {
      return usage_error(text);
    }
    if (auto can = outputs_can_be_written(*command); !can) return report_error(can.error());
  }
  const Result<int> result = chosen();
  return result ? *result : report_error(result.error());
}

}  // namespace animeme::tools
