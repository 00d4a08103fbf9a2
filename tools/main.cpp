// The program `animeme`: one command for each task, see commands/.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "tools/commands/common.h"
#include "tools/commands/did_you_mean.h"
#include "tools/commands/outputs.h"
#include "tools/files/unfinished.h"

#ifdef __GLIBC__  // known from the headers above
#include <malloc.h>
#endif

namespace {

using animeme::Code;
using animeme::Error;
using animeme::Result;
using animeme::tools::Action;
using animeme::tools::Command;

// Errors of the user's input and errors of ours have different exit codes.
int report(const Error& error) {
  std::cerr << "animeme: error: " << error.describe() << "\n";
  return error.code == Code::internal ? animeme::tools::kInternal : animeme::tools::kBadInput;
}

int run(int argc, char** argv) {
  using namespace animeme::tools;  // NOLINT: the command list reads better without prefixes
  CLI::App app{
      "Animeme: speech to MPEG-4 facial animation.\n"
      "Makes faces talk (FAPs), codes them (FBA, a few kbit/s) and muxes them with the voice."};
  app.name("animeme");
  app.require_subcommand(1);
  app.set_version_flag("--version", "animeme " ANIMEME_VERSION);
  app.footer(
      "'animeme COMMAND --help' explains a command.\n"
      "Exit codes: 0 ok, 1 a check failed or a recording ended early, 2 usage, 3 bad input, 4\n"
      "internal error, 130 stopped by Ctrl-C (what was written so far is complete).");
  bool quiet = false;
  app.add_flag("-q,--quiet", quiet, "No talk on standard error but errors");
  bool verbose = false;
  app.add_flag("-v,--verbose", verbose, "More talk: which sounds a model lacks, and what is said");
  app.fallthrough();

  const Command* commands[] = {
      &kSpeak,  &kFollow,   &kAlign,    &kCorpus, &kTrain,  &kEvaluate, &kEncode, &kDecode, &kMux,
      &kDemux,  &kInfo,     &kCompare,  &kCheck,  &kStats,  &kPlot,     &kView,   &kRender, &kHead,
      &kImport, &kCrossmap, &kRetarget, &kExport, &kStream, &kReceive,  &kPhones};
  Action chosen;
  for (const Command* command : commands) {
    CLI::App* sub = app.add_subcommand(command->name, command->summary);
    sub->footer(std::string("Examples:\n") + command->examples);
    Action action = command->add(*sub);
    sub->callback([&chosen, action] { chosen = action; });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      const std::string guess = did_you_mean(app, {argv + 1, std::size_t(argc - 1)});
      if (!guess.empty()) return usage_error(guess);
    }
    return app.exit(error) == 0 ? kOk : kUsage;
  }
  set_quiet(quiet);
  set_verbose(verbose);
  for (const CLI::App* command : app.get_subcommands()) {
    if (const std::string text = problem_with_outputs(*command); !text.empty()) {
      return usage_error(text);
    }
  }
  const Result<int> result = chosen();
  return result ? *result : report(result.error());
}

// Meshes, pictures and sums of some megabytes come and go: taken back by the system each time, they
// cost a tenth of the time of training, or of a picture, for pages that are new.
void keep_memory() {
#ifdef __GLIBC__
  ::mallopt(M_MMAP_THRESHOLD, 32 << 20);
  ::mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_memory();
  std::ios::sync_with_stdio(false);
  animeme::tools::clean_up_on_signals();
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::cerr << "animeme: error: there is not enough memory for this; close other programs, raise "
                 "the limit (ulimit -v), or work on a part\n";
    return animeme::tools::kInternal;
  } catch (const std::exception& error) {
    std::cerr << "animeme: internal error: " << error.what() << "\n";
    return animeme::tools::kInternal;
  }
}
