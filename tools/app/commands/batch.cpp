#include <cstdio>

#include "tools/app/batch/batch.h"
#include "tools/app/commands/batch_run.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/shard.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/programs/command_template.h"

namespace animeme::tools {

namespace {

struct BatchOptions {
  batch::Settings settings;
  std::vector<std::string> sets;
  std::string form, shard;
  unsigned jobs = 0;
  bool check = false, join = false, json = false, profile = false;
};

// What was done now, a minute of speech of it.
void print_profile(const batch::Standing& standing) {
  const double minutes = standing.speech_seconds / 60;
  if (minutes <= 0) return say("--profile: no speech of known length was made");
  say(format("%-10s %14s %14s   of %.1f min of speech", "step", "CPU s per min", "bytes per min",
             minutes));
  for (std::size_t i = 0; i < kSteps; ++i) {
    const Cost& cost = standing.costs[i];
    if (cost.cpu_seconds == 0 && cost.bytes == 0) continue;
    say(format("%-10s %14.4f %14.0f", kStepNames[i], cost.cpu_seconds / minutes,
               double(cost.bytes) / minutes));
  }
  say(format("%-10s %14.4f", "all", cpu_seconds(standing) / minutes));
}

void print_json(const batch::Standing& standing, const batch::Totals& totals, double seconds,
                bool stopped) {
  std::printf("%s\n", pretty(Json{{"clips", totals.rows},
                                  {"ok", totals.good},
                                  {"failed", totals.failed},
                                  {"with_warnings", totals.with_warnings},
                                  {"speech_seconds", totals.seconds},
                                  {"bytes", totals.bytes},
                                  {"done_now", standing.done - standing.skipped},
                                  {"skipped", standing.skipped},
                                  {"stopped", stopped},
                                  {"seconds", seconds},
                                  {"cpu_seconds", cpu_seconds(standing)},
                                  {"steps", steps_json(standing)}})
                          .c_str());
}

// What is wrong with the options, as a sentence; fills in what they say.
std::string take(const BatchOptions& given, batch::Settings& settings) {
  if (settings.shared.out.empty()) return "-o FOLDER is missing";
  settings.form = batch::form_of(settings.manifest);
  if (given.form == "tsv") settings.form = batch::Form::table;
  if (given.form == "csv") settings.form = batch::Form::csv;
  if (given.form == "jsonl") settings.form = batch::Form::json;
  if (given.form == "list") settings.form = batch::Form::list;
  for (const std::string& one : given.sets) {
    const std::size_t equals = one.find('=');
    if (equals == std::string::npos) return "--set wants COLUMN=VALUE, not " + one;
    settings.defaults.emplace_back(one.substr(0, equals), one.substr(equals + 1));
  }
  if (!given.shard.empty()) read_shard(given.shard, settings.shard, settings.shards);
  if (!settings.shared.store.empty() && settings.shared.to.empty()) {
    return "--store wants --to, what {uri} begins with";
  }
  for (const std::string* hook : {&settings.shared.fetch, &settings.shared.store}) {
    if (hook->empty()) continue;
    const auto command = parse_command(*hook);
    if (!command) return command.error().message;
    if (!command->names("file") || !command->names("uri")) {
      return "--fetch and --store need {uri} and {file}";
    }
  }
  prepare_batch(settings, given.jobs);
  return {};
}

Result<int> check(const batch::Settings& settings) {
  auto manifest = batch::Manifest::open(settings.manifest, settings.form, settings.defaults,
                                        settings.allow_commands);
  if (!manifest) return manifest.error();
  std::vector<std::string> problems;
  const auto rows = batch::check_manifest(*manifest, settings.shard, settings.shards, problems);
  if (!rows) return rows.error();
  for (const std::string& one : problems) std::fprintf(stderr, "%s\n", one.c_str());
  say(format("%llu rows, %zu problems", static_cast<unsigned long long>(*rows), problems.size()));
  return problems.empty() ? kOk : kBadInput;
}

Result<int> run(const BatchOptions& options) {
  batch::Settings settings = options.settings;
  if (const std::string text = take(options, settings); !text.empty()) return usage_error(text);
  if (options.check) return check(settings);
  if (options.join) {
    const Result<batch::Totals> totals = batch::join_batch(settings);
    if (!totals) return totals.error();
    if (options.json) print_json({}, *totals, 0, false);
    say(settings.shared.out + format("/index.tsv: %llu clips, %llu failed",
                                     static_cast<unsigned long long>(totals->rows),
                                     static_cast<unsigned long long>(totals->failed)));
    return totals->failed > 0 ? kCheckFailed : kOk;
  }
  double seconds = 0;
  const Result<batch::Ending> ending = run_batch_shown(settings, "clips", seconds);
  if (!ending) return ending.error();
  const batch::Standing& now = ending->standing;
  if (options.json) print_json(now, ending->totals, seconds, ending->stopped);
  say(settings.shared.out +
      format(": %llu of %llu clips in %s, %llu of them unchanged, %llu failed; %.1f CPU s",
             static_cast<unsigned long long>(now.done), static_cast<unsigned long long>(now.wanted),
             clock_text(seconds).c_str(), static_cast<unsigned long long>(now.skipped),
             static_cast<unsigned long long>(now.failed), cpu_seconds(now)));
  if (options.profile) print_profile(now);
  if (ending->stopped) {
    say("stopped; continue with the same command and --resume");
    return kInterrupted;
  }
  return ending->totals.failed > 0 ? kCheckFailed : kOk;
}

void add_options(OptionTable& cli, BatchOptions& options) {
  batch::Settings& settings = options.settings;
  cli.add(
         "manifest", settings.manifest,
         "Table with a row per clip: .tsv or .csv with column names in the first line, .jsonl with "
         "an object per line, .json with a list of them, .txt or .lst with a file per line; - for "
         "standard input")
      ->required();
  cli.add("-o,--output", settings.shared.out, "Folder for the outputs, index.tsv and report.html")
      ->output("", OutputKind::folder)
      ->required();
  cli.add("--set", options.sets, "Default value of a column: lang=de, outputs=\".fba .TextGrid\"")
      ->value("COLUMN=VALUE")
      ->one_at_a_time();
  cli.add("--form", options.form, "Format of the manifest: tsv, csv, jsonl or list")
      ->one_of("tsv csv jsonl list");
  cli.add("--jobs", options.jobs, "Clips in parallel; default: one per core")->between(1, 512);
  cli.add("--resume", settings.resume,
          "Skip clips that are done and unchanged: row, content of the inputs, version of "
          "the program");
  cli.add("--shard", options.shard,
          "Process only this part of the clips, chosen by their ids: 1/4 to 4/4")
      ->value("I/N")
      ->check(problem_of_shard);
  cli.add("--join", options.join,
          "Check that all shards in the folder are complete, and merge their indexes");
  cli.add("--check", options.check, "Only check the manifest");
  cli.add("--allow-commands", settings.allow_commands,
          "Let rows of the manifest name programs to run: column tts, --tts in options");
  cli.add("--fetch", settings.shared.fetch,
          "Command that downloads inputs whose names contain ://, such as \"rclone copyto "
          "{uri} {file}\"")
      ->value("COMMAND");
  cli.add("--store", settings.shared.store,
          "Command that uploads outputs, such as \"rclone copyto {file} {uri}\"; they are then "
          "removed from the folder")
      ->value("COMMAND");
  cli.add("--to", settings.shared.to, "Prefix of {uri} of --store: s3://bucket/talk/");
  cli.add("--profile", options.profile,
          "Print CPU seconds and bytes per minute of speech for each step");
  cli.add("--json", options.json, "Print a machine-readable summary");
}

}  // namespace

const Command kBatch{
    "batch", "Process many clips from a table, with resume and shards",
    "  printf 'id\\ttext\\tlang\\nhello\\tHello world\\ten\\nhallo\\tGuten Tag\\tde\\n' > "
    "clips.tsv\n"
    "  animeme batch clips.tsv -o out --set outputs=.fba\n"
    "  animeme batch clips.tsv -o out --set outputs=.fba --resume    # after Ctrl-C, or a change\n"
    "  animeme batch clips.jsonl -o out --shard 2/8                  # on the second machine of "
    "eight\n"
    "  animeme batch clips.jsonl -o out --join                       # after all of them\n"
    "  ls *.wav | animeme batch - --form list -o out --set outputs=\".mp4 render:.video.mp4\"\n"
    "Columns: id text text_file script audio transcript input lang voice tts model head over "
    "outputs\n"
    "options encode_options render_options export_options align_options",
    set_up<BatchOptions>};

}  // namespace animeme::tools
