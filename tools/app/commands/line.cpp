#include "tools/app/commands/line.h"

#include <algorithm>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "tools/app/commands/common.h"
#include "tools/app/commands/damage.h"
#include "tools/app/commands/did_you_mean.h"
#include "tools/app/commands/help.h"
#include "tools/app/commands/licences.h"
#include "tools/app/commands/outputs.h"
#include "tools/app/commands/parse_line.h"
#include "tools/app/commands/report.h"
#include "tools/app/commands/settings_file.h"

namespace animeme::tools {

namespace {

constexpr const Command* kCommands[] = {
    &kSpeak,  &kBatch,  &kDub,   &kFollow,  &kAlign,  &kCorpus, &kTrain,    &kEvaluate,
    &kEncode, &kDecode, &kMux,   &kDemux,   &kEdit,   &kInfo,   &kCompare,  &kCheck,
    &kStats,  &kPlot,   &kView,  &kRender,  &kHead,   &kImport, &kCrossmap, &kRetarget,
    &kExport, &kStream, &kServe, &kReceive, &kPhones, &kManual};

// Common options, and where they go.
struct CommonFlags {
  bool quiet = false;
  bool verbose = false;
  bool report = false;
  bool strict = false;
};

// They read streams, and do what can be done with damaged ones.
constexpr std::string_view kRepair[] = {"encode",  "decode",   "mux",    "demux", "info",
                                        "compare", "edit",     "stats",  "plot",  "view",
                                        "render",  "retarget", "export", "stream"};

// Of the command that runs, without those of its settings file.
std::vector<std::string>& line_words() {
  static std::vector<std::string> words;
  return words;
}

OptionTable common_table(CommonFlags& flags) {
  OptionTable table(
      "animeme",
      "Animeme: MPEG-4 facial animation from text and speech.\n"
      "Animates faces (FAPs), encodes the motion (FBA, a few kbit/s) and muxes it with sound.",
      "'animeme help COMMAND' explains a command.\n"
      "Exit codes: 0 ok, 1 a check failed, a recording ended early or a stream is damaged, 2 "
      "usage, 3 bad input, "
      "4 internal error, 130 stopped by Ctrl-C (what was written so far is complete).");
  table.add("-V,--version", {}, "Print the version; with --verbose also libraries and licences");
  table.add("-q,--quiet", flags.quiet, "Print errors only");
  table.add("-v,--verbose", flags.verbose,
            "Print more details, such as phones that the model lacks");
  return table;
}

// Adds the flags that many commands have: --json of those that have no report of their own, and
// --strict.
OptionTable table_of(const Command& command, Action& action, CommonFlags& flags) {
  OptionTable table(command.name, command.summary, std::string("Examples:\n") + command.examples);
  action = command.add(table);
  if (table.find("--json") == nullptr) {
    table.add("--json", flags.report, "Print what was written, or what went wrong, as JSON");
  }
  if (std::find(std::begin(kRepair), std::end(kRepair), command.name) != std::end(kRepair)) {
    table.add("--strict", flags.strict,
              "Fail at the first damage in a stream; default: hold the last intact frame where "
              "planes are "
              "damaged, write the rest, exit code 1");
  }
  return table;
}

const Command* find_command(const std::string& name) {
  const auto* const found = std::find_if(std::begin(kCommands), std::end(kCommands),
                                         [&](const Command* one) { return name == one->name; });
  return found == std::end(kCommands) ? nullptr : *found;
}

bool has_word(const std::vector<const char*>& words, std::string_view wanted) {
  return std::find(words.begin(), words.end(), wanted) != words.end();
}

// The words behind the program's name, with `help` and `version` as the options that they mean.
std::vector<const char*> plain_words(std::span<const char* const> arguments) {
  std::vector<const char*> words(arguments.begin(), arguments.end());
  const std::string_view first = words.empty() ? "" : words.front();
  if (first == "version") words.front() = "--version";
  if (first == "help") {
    words.erase(words.begin());
    words.push_back("--help");
  }
  return words;
}

}  // namespace

OptionTable program_table() {
  static CommonFlags flags;  // nothing is parsed
  static std::vector<Action> actions(std::size(kCommands));
  OptionTable program = common_table(flags);
  for (std::size_t i = 0; i < actions.size(); ++i) {
    program.commands.push_back(table_of(*kCommands[i], actions[i], flags));
  }
  return program;
}

int run_line(std::span<const char* const> arguments) {
  std::vector<const char*> words = plain_words(arguments.subspan(1));
  const auto name =
      std::find_if(words.begin(), words.end(), [](const char* word) { return word[0] != '-'; });
  const Command* const command = name == words.end() ? nullptr : find_command(*name);
  set_reporting(command == nullptr ? "" : command->name, has_word(words, "--json"));
  if (command == nullptr && name != words.end()) {
    return usage_error(did_you_mean(program_table(), words));
  }
  CommonFlags flags;
  OptionTable program = common_table(flags);
  Action action;
  if (command != nullptr) program.commands.push_back(table_of(*command, action, flags));
  OptionTable* const table = command == nullptr ? nullptr : &program.commands.front();
  line_words().assign(words.begin(), words.end());
  const Result<std::vector<std::string>> settings =
      table == nullptr ? std::vector<std::string>() : settings_words(*table, words);
  if (!settings && settings.error().code == Code::invalid_argument) {
    return usage_error(settings.error().describe());
  }
  if (!settings) return report_error(settings.error());
  for (const std::string& word : *settings) words.push_back(word.c_str());
  const ParsedLine line = parse_line(program, table, words);
  switch (line.action) {
    case ParsedLine::Action::help:
    case ParsedLine::Action::help_all: {
      const bool all = line.action == ParsedLine::Action::help_all;
      const OptionTable whole = program_table();
      std::cout << help_text(table == nullptr ? whole : *table, whole, all, terminal_width());
      return kOk;
    }
    case ParsedLine::Action::version:
      std::cout << version_text(has_word(words, "--verbose") || has_word(words, "-v"),
                                has_word(words, "--json"))
                << "\n";
      return kOk;
    case ParsedLine::Action::fail: {
      const std::string guess = did_you_mean(program_table(), words);
      return usage_error(guess.empty() ? line.problem : guess);
    }
    case ParsedLine::Action::run:
      break;
  }
  if (table == nullptr) {
    const OptionTable whole = program_table();
    std::cerr << help_text(whole, whole, false, terminal_width());
    return kUsage;
  }
  set_quiet(flags.quiet);
  set_verbose(flags.verbose);
  set_strict(flags.strict);
  if (const std::string text = problem_with_outputs(*table); !text.empty()) {
    return usage_error(text);
  }
  if (auto can = outputs_can_be_written(*table); !can) return report_error(can.error());
  if (flags.report) {
    for (const std::unique_ptr<Option>& option : table->options) {
      const bool to_output = option->output_kind != OutputKind::none && option->given();
      if (to_output && option->values.front() == "-") {
        return usage_error(problem_with_report());
      }
    }
  }
  const Result<int> result = action.run(action.options.get());
  if (!result) return report_error(result.error());
  if (flags.report && *result != kUsage) std::cout << report_text() << "\n";
  return *result == kOk && damage_reported() ? kCheckFailed : *result;
}

Result<void> parse_again(OptionTable& table) {
  std::vector<const char*> words;
  for (const std::string& word : line_words()) words.push_back(word.c_str());
  const Result<std::vector<std::string>> settings = settings_words(table, words);
  if (!settings) return settings.error();
  for (const std::string& word : *settings) words.push_back(word.c_str());
  CommonFlags flags;
  OptionTable program = common_table(flags);
  const ParsedLine line = parse_line(program, &table, words);
  if (line.action == ParsedLine::Action::run) return {};
  return make_error(Code::invalid_argument, line.problem);
}

}  // namespace animeme::tools
