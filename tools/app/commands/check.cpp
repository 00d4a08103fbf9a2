#include <fnmatch.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "fap/players.h"
#include "tools/app/check/report.h"
#include "tools/app/check/run_suite.h"
#include "tools/app/check/suite.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/report.h"
#include "tools/formats/common/json.h"

namespace animeme::tools {

namespace {

struct CheckOptions {
  std::vector<std::string> places;
  bool high_level = false;
  std::string decoder;
  std::string json;
  std::string junit;
  std::vector<std::string> filters;
  double timeout = 10;
  int jobs = 0;
  bool no_encode = false;
  bool coverage = false;
  std::string count = "settled";
};

// Whether the standard says what is right. Folders without case.json have no marks.
bool is_settled(const std::string& mark) { return mark.empty() || mark == "C" || mark == "S"; }

// A decoder has to end, whatever it makes of a stream.
bool has_ended(Verdict verdict) {
  return verdict != Verdict::crash && verdict != Verdict::timeout && verdict != Verdict::bad_data;
}

// A pattern with * ? [ must match all of a name or feature, a plain word may stand inside.
bool matches(const std::string& pattern, const std::string& text) {
  if (pattern.find_first_of("*?[") == std::string::npos) {
    return text.find(pattern) != std::string::npos;
  }
  return ::fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
}

bool is_chosen(const SuiteCase& one, const std::vector<std::string>& filters) {
  if (filters.empty()) return true;
  for (const std::string& pattern : filters) {
    if (matches(pattern, one.info.name)) return true;
    for (const std::string& feature : one.info.features) {
      if (matches(pattern, feature)) return true;
    }
  }
  return false;
}

// Texts are checked for players, anything else is a suite.
bool is_text(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return false;
  return path == "-" || extension_of(path) == ".fap";
}

Result<int> check_texts(const CheckOptions& options) {
  Json files = Json::array();
  int wrong = 0;
  for (const std::string& path : options.places) {
    const Result<std::string> text = read_text_file(path);
    if (!text) return text.error();
    const auto problems = fap::player_problems(*text, {.high_level = options.high_level});
    wrong += problems.empty() ? 0 : 1;
    files.push_back({{"file", path}, {"players", problems.empty()}, {"problems", problems}});
    if (options.json == "-") continue;
    if (problems.empty()) std::printf("%s: right for all players\n", path.c_str());
    for (const std::string& problem : problems) {
      std::printf("%s: %s\n", path.c_str(), problem.c_str());
    }
  }
  if (!options.json.empty()) {
    auto ok = write_file(options.json, pretty(files) + "\n");
    if (!ok) return ok.error();
  }
  return wrong == 0 ? kOk : kCheckFailed;
}

Result<int> run(const CheckOptions& options) {
  const auto texts = std::count_if(options.places.begin(), options.places.end(), is_text);
  if (texts > 0 && std::size_t(texts) == options.places.size()) return check_texts(options);
  if (options.places.size() > 1) {
    return usage_error("only FAP texts (.fap) are checked together, not " + options.places.back());
  }
  if (options.json == "-" && options.junit == "-") {
    return usage_error("--json and --junit cannot both go to standard output");
  }
  RunOptions run;
  if (!options.decoder.empty()) {
    Result<CommandTemplate> command = parse_command(options.decoder);
    if (!command) return usage_error(command.error().message);
    if (!command->names("in")) {
      return usage_error(
          "the command needs {in} where the stream's file goes, as in 'player {in} {out}'");
    }
    run.command = std::move(*command);
  }
  Result<Suite> suite = load_suite(options.places.front());
  if (!suite) return suite.error();
  std::vector<const SuiteCase*> chosen;
  for (SuiteCase& one : suite->cases) {
    if (!is_chosen(one, options.filters)) continue;
    if (!options.coverage) verify(one);
    chosen.push_back(&one);
  }
  if (chosen.empty()) return usage_error("no case has a name or feature that matches --filter");
  if (options.coverage) {
    auto written = write_file("-", coverage_table(chosen));
    if (!written) return written.error();
    return kOk;
  }

  run.encode = !options.no_encode;
  run.timeout_seconds = options.timeout;
  run.jobs = options.jobs > 0 ? std::size_t(options.jobs)
                              : std::max(1U, std::thread::hardware_concurrency());
  ProgressLine progress("checking");
  run.progress = [&](std::size_t done, const std::string& name) {
    progress.update(double(done) / double(chosen.size()), name);
  };
  Result<std::vector<CaseResult>> results = run_suite(chosen, run);
  if (!results) return results.error();
  progress.clear();

  const bool own = !run.command;
  for (CaseResult& result : *results) {
    const bool all = own || options.count == "all";
    result.counts = all || is_settled(result.one->info.certainty) || !has_ended(result.verdict);
  }
  report_printed();
  if (options.json != "-" && options.junit != "-") {
    if (auto ok = write_file("-", text_report(*results, own)); !ok) return ok.error();
  }
  if (!options.json.empty()) {
    const std::string decoder = own ? "animeme" : options.decoder;
    auto ok = write_file(options.json, json_report(*suite, *results, decoder));
    if (!ok) return ok.error();
  }
  if (!options.junit.empty()) {
    if (auto ok = write_file(options.junit, junit_report(*suite, *results)); !ok) return ok.error();
  }
  const Tally sum = tally(*results);
  if (sum.bad_data > 0) {
    return make_error(Code::syntax,
                      std::to_string(sum.bad_data) +
                          " cases differ from the published ones; download them again")
        .in_file(options.places.front());
  }
  return sum.all_right() ? kOk : kCheckFailed;
}

void add_options(OptionTable& cli, CheckOptions& options) {
  cli.add("place", options.places,
          "Folder of cases (conformance), a .tar.xz of them, or a folder of X.fba with "
          "X.dec.fap or X.dec.bap; or FAP texts, to check whether old players read them "
          "correctly")
      ->required();
  cli.add("--high-level", options.high_level,
          "FAP texts are for players that support FAP 1 and 2, such as Xface");
  cli.add("--decoder", options.decoder,
          "Another decoder: its command with {in} {out} {bap} for the files; without {out} "
          "its standard output is read. No shell is run");
  cli.add("--filter", options.filters,
          "Only cases whose name or feature contains this, or matches it with * ? []; may be "
          "repeated");
  cli.add("--count", options.count,
          "Failures of --decoder that make the exit code 1: settled, those in cases that the "
          "standard settles (marks C and S); all, others, too (M, T and ?)")
      ->one_of("settled all")
      ->show_default();
  cli.add("--timeout", options.timeout, "Seconds per case")->between(0.01, 86400.0)->show_default();
  cli.add("--jobs", options.jobs, "Cases in parallel; 0: one per core")
      ->between(0, 256)
      ->show_default();
  cli.add("--no-encode", options.no_encode,
          "Only decode; do not encode the streams again from their parameters");
  cli.add("--coverage", options.coverage, "Run nothing, print which features the cases cover");
  cli.add("--json", options.json, "Write results as JSON to this file, - for standard output")
      ->output(".json");
  cli.add("--junit", options.junit, "Write results as JUnit XML to this file")->output(".xml");
}

}  // namespace

const Command kCheck{
    "check",
    "Run conformance cases against this or another decoder, or check FAP texts for "
    "players; exit code 1 if one fails",
    "  animeme check talk.fap\n"
    "  animeme check conformance\n"
    "  animeme check conformance --decoder \"mydecoder {in} {out} {bap}\"\n"
    "  animeme check conformance --decoder \"mydecoder --fap {in}\" --filter "
    "'range*' --json results.json",
    set_up<CheckOptions>};

}  // namespace animeme::tools
