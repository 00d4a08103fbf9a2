#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

#include "conformance/sha256.h"
#include "tools/app/batch/batch.h"
#include "tools/app/batch/plan.h"
#include "tools/app/commands/batch_run.h"
#include "tools/app/commands/common.h"
#include "tools/app/commands/interrupt.h"
#include "tools/app/commands/line.h"
#include "tools/app/dub/dub_report.h"
#include "tools/app/dub/dub_table.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/files/file_lock.h"
#include "tools/formats/files/output_file.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/mux.h"
#include "tools/formats/programs/run_program.h"
#include "tools/speech/talking/cue_voice.h"

namespace animeme::tools {

namespace {

namespace fs = std::filesystem;

constexpr double kLongestMux = 6 * 3600;  // seconds

struct DubOptions {
  batch::Settings settings;
  dub::TableSettings table;
  std::vector<std::string> sets;
  std::string form, over;
  std::string film = "film.mp4";
  unsigned jobs = 0;
  bool no_film = false, subtitles = false, check = false, json = false;
};

std::string problem_of_film(const std::string& name) {
  const std::string ending = extension_of(name);
  const bool known = ending == ".mp4" || ending == ".mkv" || ending == ".m3u8" || ending == ".mpd";
  if (name.find('/') != std::string::npos || name.starts_with('.') || !known) {
    return "it is the name of a file in the folder of outputs: .mp4, .mkv, .m3u8 or .mpd";
  }
  return {};
}

// What is wrong with the options, as a sentence; fills in what they say.
std::string take(const DubOptions& given, batch::Settings& settings) {
  settings.form = batch::form_of(settings.manifest);
  if (settings.form == batch::Form::list) settings.form = batch::Form::table;
  if (given.form == "tsv") settings.form = batch::Form::table;
  if (given.form == "csv") settings.form = batch::Form::csv;
  if (given.form == "jsonl") settings.form = batch::Form::json;
  for (const std::string& one : given.sets) {
    const std::size_t equals = one.find('=');
    if (equals == std::string::npos) return "--set wants COLUMN=VALUE, not " + one;
    settings.defaults.emplace_back(one.substr(0, equals), one.substr(equals + 1));
  }
  if (!given.over.empty()) settings.defaults.emplace_back("over", given.over);
  settings.dialect = dub::dialect_of_dub(given.table);
  settings.report = false;
  prepare_batch(settings, given.jobs);
  return {};
}

Result<batch::Manifest> open_table(const batch::Settings& settings) {
  return batch::Manifest::open(settings.manifest, settings.form, settings.defaults,
                               settings.allow_commands, settings.dialect);
}

// Rows with an input included.
Result<batch::Manifest> open_whole_table(const DubOptions& options,
                                         const batch::Settings& settings) {
  dub::TableSettings table = options.table;
  table.originals = true;
  batch::Settings whole = settings;
  whole.dialect = dub::dialect_of_dub(table);
  return open_table(whole);
}

// What is wrong with the table. Rows make no file that has the name of one of ours.
Result<std::vector<std::string>> problems_of_table(const DubOptions& options,
                                                   const batch::Settings& settings,
                                                   std::size_t& rows) {
  auto table = open_table(settings);
  if (!table) return table.error();
  std::vector<std::string> problems;
  const auto made = batch::check_manifest(*table, 1, 1, problems);
  if (!made) return made.error();
  rows = 0;
  if (!problems.empty()) return problems;
  auto whole = open_whole_table(options, settings);
  if (!whole) return whole.error();
  for (;; ++rows) {
    const auto row = whole->next();
    if (!row) return row.error();
    if (!*row) break;
    const auto plan = batch::plan_row(**row, ".");
    if (!plan) continue;  // the row will tell
    for (const std::string& name : plan->outputs) {
      const bool ours = name == "report.json" || name == "report.csv" ||
                        (!options.no_film && name == options.film);
      if (!ours) continue;
      problems.push_back(error_at_line(Code::syntax,
                                       "the output " + name +
                                           " is the name of a file of the dub itself; give the "
                                           "row another id, or use --name",
                                       (*row)->line)
                             .in_file(whole->name())
                             .describe());
    }
  }
  if (rows == 0) problems.push_back(whole->name() + ": the table has no rows");
  return problems;
}

Result<Json> read_json_file(const std::string& path) {
  const auto text = read_text_file(path);
  if (!text) return text.error();
  auto json = Json::parse(*text);
  if (!json) return json.error().in_file(path);
  return json;
}

// Everything that was made, and the tracks of the film in the order of the table.
struct Made {
  dub::DubReport report;
  std::vector<dub::FilmTrack> tracks;
  std::size_t failed = 0;
};

Result<Made> gather(const DubOptions& options, const batch::Settings& settings) {
  const std::string& out = settings.shared.out;
  auto table = open_whole_table(options, settings);
  if (!table) return table.error();
  const auto index = batch::Index::open(out + "/" + batch::index_name(1, 1), false);
  if (!index) return index.error();
  Made made;
  for (;;) {
    const auto row = table->next();
    if (!row) return row.error();
    if (!*row) break;
    const dub::FilmTrack track = dub::film_track(**row, out);
    dub::LanguageRow language;
    language.id = track.id;
    language.lang = track.lang;
    language.speaker = track.speaker;
    if (track.original) {
      language.state = "original";
      made.report.languages.push_back(std::move(language));
      made.tracks.push_back(track);
      continue;
    }
    const batch::Index::Known* known = index->find(track.id);
    std::optional<batch::Entry> entry;
    if (known != nullptr) {
      const auto line = index->line(*known);
      if (!line) return line.error();
      entry = batch::read_index_line(std::string_view(*line).substr(0, line->size() - 1));
    }
    if (!entry || !entry->good) {
      language.state = "failed";
      language.error = entry ? entry->error : "has no line in the index";
      made.report.languages.push_back(std::move(language));
      ++made.failed;
      continue;
    }
    language.state = "made";
    // Subtitles that are too long have columns of their own.
    std::copy_if(
        entry->warnings.begin(), entry->warnings.end(), std::back_inserter(language.warnings),
        [](const std::string& warning) { return !warning.ends_with(" of its characters"); });
    for (const std::string& name : entry->outputs)
      if (!name.ends_with(dub::kReportEnding)) language.outputs.push_back(name);
    const auto told = read_json_file(out + "/" + track.id + std::string(dub::kReportEnding));
    if (!told) return told.error();
    dub::add_language(made.report, std::move(language), *told);
    made.tracks.push_back(track);
  }
  dub::sort_cues(made.report);
  return made;
}

// What the film is made from: the rows that were made, the originals, and how.
Result<std::string> film_hash(const DubOptions& options, const batch::Settings& settings,
                              const Made& made) {
  const auto index = read_text_file(settings.shared.out + "/" + batch::index_name(1, 1));
  if (!index) return index.error();
  std::string all = *index;
  const auto add = [&all](const std::string& text) { all.append(text).push_back('\0'); };
  add(options.film);
  add(options.subtitles ? "subtitles" : "");
  add(settings.shared.version);
  for (const dub::FilmTrack& track : made.tracks) {
    add(track.lang);
    add(track.speaker);
    add(track.id);
    if (!track.original) continue;
    for (const std::string* path : {&track.face, &track.audio, &track.words}) {
      add(*path);
      if (path->empty() || (path == &track.audio && track.audio == track.face)) continue;
      const auto bytes = read_file(*path);
      if (!bytes) return bytes.error();
      add(conformance::sha256(*bytes));
    }
  }
  return conformance::sha256(all).substr(0, 16);
}

// Runs a line of the program in a process of its own, which takes its memory with it. Its warnings
// are ours.
Result<void> run_apart(const std::vector<std::string>& words, const std::string& stage) {
  ChildJob job;
  job.work = [&words] {
    std::vector<const char*> line{"animeme"};
    for (const std::string& word : words) line.push_back(word.c_str());
    return run_line(line);
  };
  job.err = stage + "/err";
  job.most_bytes = std::uint64_t(1) << 40;
  ProgramRun run;
  run.what = words.front();
  run.seconds = kLongestMux;
  run.progress.stop = [] { return Interrupt::requested(); };
  if (auto ran = run_program(job, run); !ran) return ran;
  const auto said = read_text_file(job.err);
  constexpr std::string_view kWarning = "animeme: warning: ";
  for (std::size_t at = 0; said && at < said->size();) {
    const std::size_t end = std::min(said->find('\n', at), said->size());
    const std::string_view line = std::string_view(*said).substr(at, end - at);
    if (line.starts_with(kWarning)) warn(std::string(line.substr(kWarning.size())));
    at = end + 1;
  }
  return {};
}

// An original whose sound cannot be copied gets a file with one that can.
Result<void> give_coded_sound(dub::FilmTrack& track, std::size_t number, const std::string& stage) {
  if (!track.original || track.audio.empty()) return {};
  if (media::read_encoded_audio(track.audio)) return {};
  const std::string file = stage + "/original" + std::to_string(number) + ".mp4";
  if (auto ran = run_apart({"mux", track.face, track.audio, "-o", file}, stage); !ran) return ran;
  track.face = track.audio = file;
  return {};
}

Result<void> move_into_place(const std::string& from, const std::string& to) {
  std::error_code failed;
  if (fs::is_directory(to, failed)) fs::remove_all(to, failed);
  fs::rename(from, to, failed);
  if (failed) return make_error(Code::io, "cannot be written: " + failed.message()).in_file(to);
  return {};
}

// The file with all languages, unless it is there already.
Result<void> make_film(const DubOptions& options, const batch::Settings& settings, Made& made,
                       const std::string& stage) {
  const std::string& out = settings.shared.out;
  const std::string place = out + "/" + options.film;
  dub::FilmFile& film = made.report.film;
  const auto hash = film_hash(options, settings, made);
  if (!hash) return hash.error();
  film = {options.film, 0, *hash};
  std::error_code missing;
  const auto before = read_json_file(out + "/report.json");
  const std::uint64_t there = fs::file_size(place, missing);
  if (before && !missing) {
    const dub::FilmFile old = dub::film_of(*before);
    const bool same = old.name == film.name && old.hash == film.hash && old.bytes == there;
    const std::string folder = media::segment_folder(place);
    if (same && (folder.empty() || fs::is_directory(folder, missing))) {
      film.bytes = old.bytes;
      return {};
    }
  }
  std::vector<std::string> line{"mux", "--audio-codec", "copy", "-o", stage + "/" + options.film};
  if (options.subtitles) line.emplace_back("--subtitles");
  for (std::size_t i = 0; i < made.tracks.size(); ++i) {
    if (auto done = give_coded_sound(made.tracks[i], i, stage); !done) return done;
    line.insert(line.end(), {"--track", dub::mux_track(made.tracks[i])});
  }
  ProgressLine shown("film");
  shown.update(0, std::to_string(made.tracks.size()) + " tracks");
  if (auto ran = run_apart(line, stage); !ran) return ran;
  shown.clear();
  // A playlist comes behind its segments: who sees it finds them.
  const std::string folder = media::segment_folder(stage + "/" + options.film);
  if (!folder.empty()) {
    if (auto moved = move_into_place(folder, media::segment_folder(place)); !moved) return moved;
  }
  if (auto moved = move_into_place(stage + "/" + options.film, place); !moved) return moved;
  film.bytes = fs::file_size(place, missing);
  return {};
}

// report.json comes last, as it tells that the film is made.
Result<void> write_reports(const dub::DubReport& report, const std::string& out,
                           const std::string& stage) {
  const std::string page = dub::report_page(report), table = dub::report_csv(report),
                    json = pretty(dub::report_json(report)) + "\n";
  const OutputText files[] = {{"report.html", page}, {"report.csv", table}, {"report.json", json}};
  for (const OutputText& file : files) {
    const std::string staged = stage + "/" + file.path;
    if (auto done = write_file(staged, file.text); !done) return done;
    if (auto done = move_into_place(staged, out + "/" + file.path); !done) return done;
  }
  return {};
}

std::string language_text(const dub::LanguageRow& row) {
  const std::string name = row.speaker.empty() ? row.lang : row.lang + " (" + row.speaker + ")";
  if (row.state == "original") return name + ": kept as it is";
  if (row.state == "failed") return name + ": " + row.error;
  std::string text = name + ": " + clock_text(row.seconds);
  if (row.cues > 0) {
    text += format(", %zu subtitles, speed %.2f to %.2f", row.cues, row.slowest, row.fastest);
    text += row.late == 0 ? std::string(", all in their time")
                          : format(", %zu too long: cut %zu character%s", row.late, row.cut,
                                   row.cut == 1 ? "" : "s");
  }
  if (row.confidence) text += format(", confidence %.2f", *row.confidence);
  return text;
}

void print_json(const Made& made, const batch::Ending& ending, double seconds) {
  Json json = dub::summary_json(made.report);
  json["rows"] = made.report.languages.size();
  json["failed"] = made.failed;
  json["done_now"] = ending.standing.done - ending.standing.skipped;
  json["skipped"] = ending.standing.skipped;
  json["seconds"] = seconds;
  json["cpu_seconds"] = cpu_seconds(ending.standing);
  std::printf("%s\n", pretty(json).c_str());
}

Result<int> run(const DubOptions& options) {
  batch::Settings settings = options.settings;
  if (const std::string text = take(options, settings); !text.empty()) return usage_error(text);
  const std::string& out = settings.shared.out;
  std::size_t rows = 0;
  const auto problems = problems_of_table(options, settings, rows);
  if (!problems) return problems.error();
  if (options.check) {
    for (const std::string& one : *problems) std::fprintf(stderr, "%s\n", one.c_str());
    say(format("%zu rows, %zu problems", rows, problems->size()));
    return problems->empty() ? kOk : kBadInput;
  }
  if (!problems->empty()) return batch::problem_error(*problems);
  std::error_code failed;
  fs::create_directories(out, failed);
  const auto lock = FileLock::take(out + "/report.html");
  if (!lock) return lock.error();
  const std::string stage = out + "/.dub";
  fs::remove_all(stage, failed);
  const Interrupt interrupt;
  double seconds = 0;
  const auto ending = run_batch_shown(settings, "languages", seconds);
  if (!ending) return ending.error();
  if (ending->stopped) {
    say("stopped; continue with the same command and --resume");
    return kInterrupted;
  }
  auto made = gather(options, settings);
  if (!made) return made.error();
  fs::create_directories(stage, failed);
  std::optional<Error> no_film;
  if (!options.no_film && made->failed == 0) {
    if (auto done = make_film(options, settings, *made, stage); !done) {
      made->report.film = {};
      no_film = done.error();
    }
  }
  if (Interrupt::requested()) {
    fs::remove_all(stage, failed);
    say("stopped; continue with the same command and --resume");
    return kInterrupted;
  }
  if (auto done = write_reports(made->report, out, stage); !done) return done.error();
  fs::remove_all(stage, failed);
  if (no_film) return *no_film;
  if (options.json) print_json(*made, *ending, seconds);
  for (const dub::LanguageRow& row : made->report.languages) {
    for (const std::string& warning : row.warnings) warn(row.id + ": " + warning);
    say(language_text(row));
  }
  if (!made->report.film.name.empty()) {
    say(out + "/" + options.film +
        format(": %zu tracks of faces, %llu bytes", made->tracks.size(),
               static_cast<unsigned long long>(made->report.film.bytes)));
  } else if (made->failed > 0) {
    say("rows failed, so there is no file with all languages; mend them and add --resume");
  }
  say(out + "/report.html: each subtitle, worst first");
  return made->failed > 0 ? kCheckFailed : kOk;
}

void add_options(OptionTable& cli, DubOptions& options) {
  batch::Settings& settings = options.settings;
  cli.add("table", settings.manifest,
          "Table with a row per language, or per person and language: .csv or .tsv with column "
          "names in the first line, .json with a list of objects, .jsonl with an object per line; "
          "- for standard input")
      ->required();
  cli.add("-o,--output", settings.shared.out,
          "Folder for a file per row, the film, report.html, report.csv and report.json")
      ->output("", OutputKind::folder)
      ->required();
  cli.add("--over", options.over,
          "Keep the face of this performance under the new lips, in rows without column over")
      ->value("FILE");
  cli.add("--fit", options.table.fit,
          "Range of the voices' speed, as a share of their usual one, in rows without column fit")
      ->value("SLOWEST-FASTEST=0.8-1.3")
      ->check(problem_of<speech::parse_fit_range>);
  cli.add("--film", options.film,
          "Name of the file with all languages, the first row being the default: .mp4 .mkv .m3u8 "
          ".mpd")
      ->value("NAME=film.mp4")
      ->check(problem_of_film);
  cli.add("--no-film", options.no_film, "Only make a file per row")->excludes("--film");
  cli.add("--subtitles", options.subtitles,
          "Give the file with all languages tracks of captions that players show");
  cli.add("--name", options.table.name,
          "Names of the files of rows without column id; default: {lang}, or {lang}-{speaker}")
      ->value("TEMPLATE")
      ->check(dub::problem_of_name);
  cli.add("--set", options.sets, "Default value of a column: model=me.dam, outputs=\".mp4 .fba\"")
      ->value("COLUMN=VALUE")
      ->one_at_a_time();
  cli.add("--form", options.form, "Format of the table: tsv, csv or jsonl")
      ->one_of("tsv csv jsonl");
  cli.add("--jobs", options.jobs, "Rows in parallel; default: one per core")->between(1, 512);
  cli.add("--resume", settings.resume,
          "Skip rows that are done and unchanged: row, content of the inputs, version of the "
          "program");
  cli.add("--check", options.check, "Only check the table");
  cli.add("--allow-commands", settings.allow_commands,
          "Let rows of the table name programs to run: column tts, --tts in options");
  cli.add("--json", options.json, "Print a machine-readable summary");
}

}  // namespace

const Command kDub{
    "dub", "Dub a performance into many languages from subtitles or recorded voices",
    "  printf 'lang,subtitles\\nde,de.srt\\nfr,fr.srt\\n' > film.csv\n"
    "  animeme dub film.csv --over take.fba -o out      # out/de.mp4, out/fr.mp4, out/film.mp4\n"
    "  animeme dub film.csv --over take.fba -o out --resume   # after Ctrl-C, or new subtitles\n"
    "  printf 'lang,input,subtitles,audio\\nen,en.mp4,,\\nde,,de.srt,de.wav\\n' > film.csv\n"
    "  animeme dub film.csv --over en.mp4 -o out        # en as it is, a recorded German voice\n"
    "  animeme dub film.csv --set tts=\"piper -m {lang}.onnx -f {wav}\" -o out\n"
    "Columns: lang speaker subtitles audio transcript input voice tts model over fit id head\n"
    "outputs options encode_options render_options export_options align_options",
    set_up<DubOptions>};

}  // namespace animeme::tools
