#include "tools/app/batch/work.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include "conformance/sha256.h"
#include "tools/app/batch/plan.h"
#include "tools/formats/common/json.h"
#include "tools/formats/files/files.h"
#include "tools/formats/programs/command_template.h"
#include "tools/formats/programs/run_program.h"

namespace animeme::batch {

namespace {

// A descriptor of the program goes to a file as long as one lives; that of a worker that crashes
// stays.
class Captured {
 public:
  // `path`: of the file, which is made anew.
  Captured(int descriptor, const std::string& path)
      : descriptor_(descriptor),
        old_(::dup(descriptor)),
        file_(::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600)) {
    if (file_ >= 0) ::dup2(file_, descriptor_);
  }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  ~Captured() {
    if (old_ >= 0) ::dup2(old_, descriptor_);
    if (old_ >= 0) ::close(old_);
    if (file_ >= 0) ::close(file_);
  }
  // What has been written so far.
  std::string text() const {
    std::fflush(stdout);
    std::cout.flush();
    std::cerr.flush();
    std::string all(std::size_t(std::max<off_t>(::lseek(file_, 0, SEEK_END), 0)), '\0');
    const ssize_t got = ::pread(file_, all.data(), all.size(), 0);
    all.resize(std::size_t(std::max<ssize_t>(got, 0)));
    return all;
  }

 private:
  int descriptor_, old_, file_;
};

}  // namespace

namespace fs = std::filesystem;
using tools::Json;

namespace {

constexpr const char* kWarning = "animeme: warning: ";
constexpr const char* kSaid = "/.err";
constexpr const char* kError = "animeme: error: ";

// What a file holds, as a hash. Models and heads are the same for many rows.
Result<std::string> content_of(const std::string& path) {
  struct Known {
    fs::file_time_type time;
    std::uintmax_t size = 0;
    std::string hash;
  };
  static std::map<std::string, Known> cache;
  std::error_code unknown;
  const auto time = fs::last_write_time(path, unknown);
  const std::uintmax_t size = fs::file_size(path, unknown);
  if (const auto found = cache.find(path);
      found != cache.end() && found->second.time == time && found->second.size == size) {
    return found->second.hash;
  }
  const Result<std::vector<std::uint8_t>> bytes = tools::read_file(path);
  if (!bytes) return bytes.error();
  if (cache.size() > 64) cache.clear();
  return (cache[path] = {time, size, conformance::sha256(*bytes)}).hash;
}

Result<std::string> hash_of(const Row& row, const Plan& plan) {
  std::vector<std::pair<std::string, std::string>> sorted = row.values;
  std::sort(sorted.begin(), sorted.end());
  std::string all;
  const auto add = [&all](std::string_view text) { all.append(text).push_back('\0'); };
  for (const auto& [column, value] : sorted) {
    add(column);
    add(value);
  }
  for (const std::string& path : plan.inputs) {
    const Result<std::string> content = content_of(path);
    if (!content) return content.error();
    add(*content);
  }
  return conformance::sha256(all).substr(0, 16);
}

bool all_there(const Plan& plan, const Task& task, const Shared& shared) {
  if (!shared.store.empty()) return true;  // they are where the hook took them
  std::uint64_t bytes = 0;
  for (const std::string& name : plan.outputs) {
    std::error_code missing;
    bytes += fs::file_size(shared.out + "/" + name, missing);
    if (missing) return false;
  }
  return bytes == task.known_bytes;
}

// Output of a command: the report of --json, warnings, and its last line.
void take_json(const std::string& text, Entry& entry) {
  const Result<Json> read = Json::parse(text);
  if (!read || !read->is_object()) return;
  const Json& json = *read;
  const auto number = [&](const char* name, std::optional<double>& value) {
    if (json.contains(name) && json[name].is_number()) value = json[name].get<double>();
  };
  number("seconds", entry.seconds);
  number("confidence", entry.confidence);
  // An alignment is as long as its phones.
  if (!entry.seconds && json.contains("timed_phones") && !json["timed_phones"].empty()) {
    entry.seconds = json["timed_phones"].back()["end"].get<double>();
  }
}

void take_talk(const std::string& text, Entry& entry, std::string& error) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    if (line.starts_with(kWarning)) {
      const std::string warning = line.substr(std::string_view(kWarning).size());
      if (std::find(entry.warnings.begin(), entry.warnings.end(), warning) ==
          entry.warnings.end()) {
        entry.warnings.push_back(warning);
      }
    } else if (line.starts_with(kError)) {
      error = line.substr(std::string_view(kError).size());
    } else if (error.empty() && !line.empty()) {
      error = line;
    }
  }
}

Result<void> run_line_of(const std::vector<std::string>& line, const Shared& shared,
                         const std::string& stage, Entry& entry) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    if (line[i] != "-o" && line[i] != "--save-script" && line[i] != "--report") continue;
    std::error_code ignored;
    fs::create_directories(fs::path(line[i + 1]).parent_path(), ignored);
  }
  std::vector<const char*> arguments{"animeme"};
  for (const std::string& word : line) arguments.push_back(word.c_str());
  int code = 0;
  std::string out, err, error;
  {
    const Captured first(STDOUT_FILENO, stage + "/.out"), second(STDERR_FILENO, stage + kSaid);
    code = shared.run(arguments);
    out = first.text();
    err = second.text();
  }
  take_json(out, entry);
  take_talk(err, entry, error);
  if (code == 0) return {};
  if (error.starts_with("animeme: ")) error.erase(0, 9);
  if (error.empty()) error = "ended with code " + std::to_string(code);
  return make_error(Code::invalid_argument, line.front() + ": " + error);
}

// Runs a hook with its places filled after it was cut: a name is never a command.
Result<void> run_hook(const std::string& command, const char* what, const std::string& uri,
                      const std::string& file, const std::string& errors) {
  const Result<tools::CommandTemplate> cut = tools::parse_command(command);
  if (!cut) return cut.error();
  const tools::Place places[] = {{"uri", uri}, {"file", file}};
  tools::ChildJob job;
  Result<std::vector<std::string>> arguments = tools::fill_in(*cut, places);
  if (!arguments) return arguments.error();
  job.arguments = std::move(*arguments);
  job.err = errors;
  job.most_bytes = std::uint64_t(4) << 30;
  tools::ProgramRun run;
  run.what = what;
  run.seconds = 3600;
  return tools::run_program(job, run);
}

Result<Row> fetched(const Row& row, const Shared& shared, const std::string& stage) {
  Row local = row;
  if (shared.fetch.empty()) return local;
  int number = 0;
  for (auto& [column, value] : local.values) {
    const bool file = column == "audio" || column == "script" || column == "text_file" ||
                      column == "input" || column == "model" || column == "head" ||
                      column == "over";
    if (!file || value.find("://") == std::string::npos) continue;
    const std::string place = stage + "/.fetched" + std::to_string(number++) +
                              tools::extension_of(value.substr(0, value.find_first_of("?#")));
    if (auto ran = run_hook(shared.fetch, "--fetch", value, place, stage + "/.said"); !ran) {
      return ran.error();
    }
    value = place;
  }
  return local;
}

// The files of a folder and below, by their names.
std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, failed)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// What lies in the stage: outputs, and folders beside playlists. Each takes its place by renaming.
Result<void> publish(const std::string& stage, const Plan& plan, const Shared& shared,
                     Entry& entry) {
  for (const std::string& name : plan.outputs) {
    const fs::path from = fs::path(stage) / name;
    std::error_code failed;
    const std::uint64_t bytes = fs::file_size(from, failed);
    if (failed) return make_error(Code::internal, "the output was not made").in_file(name);
    entry.bytes += bytes;
  }
  std::vector<fs::path> places;
  for (const std::string& name : plan.outputs) {
    const fs::path parent = fs::path(name).parent_path();
    if (std::find(places.begin(), places.end(), parent) == places.end()) places.push_back(parent);
  }
  for (const fs::path& parent : places) {
    const fs::path target = fs::path(shared.out) / parent;
    std::vector<fs::path> segments, others;  // for the hook
    std::error_code failed;
    fs::create_directories(target, failed);
    for (const fs::directory_entry& made :
         fs::directory_iterator(fs::path(stage) / parent, failed)) {
      const std::string name = made.path().filename().string();
      if (name.starts_with(".")) continue;
      if (!shared.store.empty()) {
        (made.is_directory() ? segments : others).push_back(made.path());
        continue;
      }
      if (made.is_directory()) fs::remove_all(target / name, failed);
      fs::rename(made.path(), target / name, failed);
      if (failed) {
        return make_error(Code::io, "cannot write: " + failed.message())
            .in_file((target / name).string());
      }
    }
    // A playlist comes behind its segments: who sees it finds them.
    std::vector<fs::path> files;
    for (const fs::path& folder : segments) {
      for (fs::path& file : files_below(folder)) files.push_back(std::move(file));
    }
    std::sort(others.begin(), others.end());
    files.insert(files.end(), others.begin(), others.end());
    for (const fs::path& file : files) {
      const std::string uri = shared.to + file.lexically_relative(stage).generic_string();
      auto ran = run_hook(shared.store, "--store", uri, file.string(), stage + "/.said");
      if (!ran) return ran;
    }
  }
  return {};
}

Result<bool> do_row(const Task& task, const Shared& shared, const std::string& stage,
                    Entry& entry) {
  // With a hook the address counts, not what lies there: to look would be to fetch.
  Result<Plan> plan = plan_row(task.row, stage);
  if (!plan) return plan.error();
  if (!shared.fetch.empty()) {
    std::erase_if(plan->inputs,
                  [](const std::string& path) { return path.find("://") != std::string::npos; });
  }
  const Result<std::string> hash = hash_of(task.row, *plan);
  if (!hash) return hash.error();
  entry.hash = *hash;
  entry.outputs = plan->outputs;
  if (!task.known.empty() && task.known == *hash && all_there(*plan, task, shared)) return true;
  const Result<Row> local = fetched(task.row, shared, stage);
  if (!local) return local.error();
  plan = plan_row(*local, stage);
  if (!plan) return plan.error();
  for (const std::vector<std::string>& line : plan->lines) {
    if (auto ran = run_line_of(line, shared, stage, entry); !ran) return ran.error();
  }
  if (auto done = publish(stage, *plan, shared, entry); !done) return done.error();
  return false;
}

}  // namespace

std::string last_said(const Shared& shared, std::size_t worker) {
  const auto said = tools::read_text_file(shared.stage + "/" + std::to_string(worker) + kSaid);
  if (!said) return {};
  Entry ignored;
  std::string error;
  take_talk(*said, ignored, error);
  return error;
}

Outcome do_task(const Task& task, const Shared& shared, std::size_t worker) {
  tools::take_costs();  // costs of earlier work are not of this row
  const std::string stage = shared.stage + "/" + std::to_string(worker);
  std::error_code ignored;
  fs::remove_all(stage, ignored);
  fs::create_directories(stage, ignored);
  Outcome outcome;
  outcome.entry.id = task.row.at("id");
  outcome.entry.version = shared.version;
  const Result<bool> done = do_row(task, shared, stage, outcome.entry);
  if (done) {
    outcome.entry.good = true;
    outcome.same = *done;
  } else {
    outcome.entry.error = done.error().describe();
    outcome.entry.outputs.clear();
    outcome.entry.bytes = 0;
  }
  // Messages name what the user knows.
  const auto forget_stage = [&](std::string& text) {
    for (std::size_t at = 0; (at = text.find(stage + "/", at)) != std::string::npos;) {
      text.erase(at, stage.size() + 1);
    }
  };
  forget_stage(outcome.entry.error);
  for (std::string& warning : outcome.entry.warnings) forget_stage(warning);
  fs::remove_all(stage, ignored);
  outcome.costs = tools::take_costs();
  return outcome;
}

}  // namespace animeme::batch
