#include "tools/batch/batch.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "fap/detail/text_scanner.h"
#include "tools/batch/plan.h"
#include "tools/batch/workers.h"
#include "tools/files/file_lock.h"

namespace animeme::batch {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostProblems = 20;

// A name and where it was met first.
struct Met {
  std::uint64_t hash;
  std::int64_t line;
};

// Lines whose names were met before, at 16 bytes a name.
void find_twice(std::vector<Met>& met, const std::string& file, const char* what,
                std::vector<std::string>& problems) {
  std::sort(met.begin(), met.end(), [](const Met& a, const Met& b) {
    return a.hash != b.hash ? a.hash < b.hash : a.line < b.line;
  });
  std::vector<Met> later;
  for (std::size_t i = 1; i < met.size() && later.size() < kMostProblems; ++i) {
    if (met[i].hash != met[i - 1].hash) continue;
    later.push_back({std::uint64_t(met[i - 1].line), met[i].line});
  }
  std::sort(later.begin(), later.end(), [](const Met& a, const Met& b) { return a.line < b.line; });
  for (const Met& one : later) {
    if (problems.size() >= kMostProblems) return;
    problems.push_back(error_at_line(Code::syntax,
                                     std::string(what) + " is that of line " +
                                         std::to_string(one.hash) +
                                         ", too (letters of either case count as one)",
                                     one.line)
                           .in_file(file)
                           .describe());
  }
}

bool is_ours(const std::string& name) {
  return name == "report.html" || name == "index.tsv" ||
         (name.starts_with("index.") && name.find("-of-") != std::string::npos) ||
         (name.starts_with("report.") && name.find("-of-") != std::string::npos);
}

Error all_of(const std::vector<std::string>& problems) {
  std::string text = "the manifest is broken, nothing was done:";
  for (const std::string& one : problems) text += "\n  " + one;
  return make_error(Code::syntax, text);
}

std::string report_name(int shard, int shards) {
  return shards <= 1
             ? "report.html"
             : "report." + std::to_string(shard) + "-of-" + std::to_string(shards) + ".html";
}

// Workers of a batch that was killed end a moment later, and hold its lock until then.
Result<tools::FileLock> take_lock(const std::string& path) {
  for (int tries = 0;; ++tries) {
    Result<tools::FileLock> lock = tools::FileLock::take(path);
    if (lock || tries >= 30) return lock;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
}

// The rows of a batch, handed out and taken back.
class Run {
 public:
  Run(const Settings& settings, Manifest& manifest, const Index& before, IndexWriter& writer,
      const Watch& watch)
      : settings_(settings),
        manifest_(manifest),
        before_(before),
        writer_(writer),
        watch_(watch),
        workers_(settings.jobs, [&settings](std::string_view message, std::size_t worker) {
          return outcome_message(do_task(read_task(message), settings.shared, worker));
        }) {
    doing_.resize(settings.jobs);
  }

  Result<void> go(Standing& standing) {
    for (;;) {
      bool more = !watch_.stop();
      while (more) {
        const std::optional<std::size_t> idle = workers_.idle();
        if (!idle) break;
        Result<bool> given = give_next(*idle);
        if (!given) return given.error();
        more = *given && !watch_.stop();
      }
      if (!workers_.busy()) return {};
      const std::optional<Workers::Answer> answer = workers_.wait(200);
      if (answer) {
        if (auto taken = take(*answer, standing); !taken) return taken;
      }
      watch_.at(standing);
    }
  }

 private:
  // False: there are no more rows.
  Result<bool> give_next(std::size_t worker) {
    for (;;) {
      const Result<std::optional<Row>> row = manifest_.next();
      if (!row) return row.error();
      if (!*row) return false;
      const std::string_view id = (*row)->at("id");
      if (shard_of(id, settings_.shards) != settings_.shard) continue;
      Task task{**row, {}, 0};
      if (const Index::Known* known = before_.find(id); known != nullptr && known->work != 0) {
        const Result<std::string> line = before_.line(*known);
        if (!line) return line.error();
        const auto entry = read_index_line(std::string_view(*line).substr(0, line->size() - 1));
        if (entry && entry->version == settings_.shared.version) {
          task.known = entry->hash;
          task.known_bytes = entry->bytes;
        }
      }
      doing_[worker] = std::string(id);
      if (auto given = workers_.give(worker, task_message(task)); !given) return given.error();
      return true;
    }
  }

  Result<void> take(const Workers::Answer& answer, Standing& standing) {
    Outcome outcome;
    if (answer.crash.empty()) {
      outcome = read_outcome(answer.message);
    } else {
      outcome.entry.id = doing_[answer.worker];
      outcome.entry.error = answer.crash;
      outcome.entry.version = settings_.shared.version;
    }
    ++standing.done;
    standing.cpu_seconds += outcome.cpu_seconds;
    if (outcome.same) {
      ++standing.skipped;
      return {};
    }
    const Entry& entry = outcome.entry;
    standing.speech_seconds += entry.seconds.value_or(0);
    if (!entry.good) {
      ++standing.failed;
      watch_.failed(entry.id + ": " + entry.error);
    }
    return writer_.add(entry);
  }

  const Settings& settings_;
  Manifest& manifest_;
  const Index& before_;
  IndexWriter& writer_;
  const Watch& watch_;
  std::vector<std::string> doing_;
  Workers workers_;
};

}  // namespace

Result<std::uint64_t> check_manifest(Manifest& manifest, int shard, int shards,
                                     std::vector<std::string>& problems) {
  std::vector<Met> ids, outputs;
  std::uint64_t rows = 0;
  while (problems.size() < kMostProblems) {
    const Result<std::optional<Row>> row = manifest.next();
    if (!row) {
      if (row.error().code != Code::syntax) return row.error();
      problems.push_back(row.error().describe());
      continue;
    }
    if (!*row) break;
    const std::string id = fap::detail::lower_case(std::string((*row)->at("id")));
    ids.push_back({stable_hash(id), (*row)->line});
    if (const Result<Plan> plan = plan_row(**row, "."); plan) {
      for (const std::string& name : plan->outputs) {
        const std::string lower = fap::detail::lower_case(name);
        outputs.push_back({stable_hash(lower), (*row)->line});
        if (is_ours(lower)) {
          problems.push_back(error_at_line(Code::syntax,
                                           "the output " + name +
                                               " is the name of a file of the "
                                               "batch itself; give the row another id",
                                           (*row)->line)
                                 .in_file(manifest.name())
                                 .describe());
        }
      }
    }
    if (shard_of((*row)->at("id"), shards) == shard) ++rows;
  }
  find_twice(ids, manifest.name(), "the id", problems);
  if (problems.empty()) find_twice(outputs, manifest.name(), "a file that the row makes", problems);
  return rows;
}

Result<Ending> run_batch(const Settings& given, const Watch& watch) {
  Settings settings = given;
  const std::string out = settings.shared.out;
  Result<Manifest> manifest = Manifest::open(settings.manifest, settings.form, settings.defaults);
  if (!manifest) return manifest.error();
  std::vector<std::string> problems;
  Result<std::uint64_t> rows = check_manifest(*manifest, settings.shard, settings.shards, problems);
  if (!rows) return rows.error();
  if (!problems.empty()) return all_of(problems);

  std::error_code failed;
  fs::create_directories(out, failed);
  const std::string path = out + "/" + index_name(settings.shard, settings.shards);
  Result<tools::FileLock> lock = take_lock(path);
  if (!lock) return lock.error();
  if (!settings.resume && fs::exists(path, failed)) {
    return make_error(Code::invalid_argument,
                      "there is a batch already; go on with --resume, or give another folder")
        .in_file(path);
  }
  settings.shared.stage =
      out + "/.batch-" + std::to_string(settings.shard) + "-of-" + std::to_string(settings.shards);
  fs::remove_all(settings.shared.stage, failed);
  Ending ending;
  ending.standing.wanted = *rows;
  {
    const Result<Index> before = Index::open(path, true);
    if (!before) return before.error();
    Result<IndexWriter> writer = IndexWriter::open(path);
    if (!writer) return writer.error();
    if (auto begun = manifest->rewind(); !begun) return begun.error();
    Run run(settings, *manifest, *before, *writer, watch);
    if (auto gone = run.go(ending.standing); !gone) return gone.error();
  }
  fs::remove_all(settings.shared.stage, failed);
  ending.stopped = ending.standing.done < ending.standing.wanted;
  if (ending.stopped) return ending;
  const Result<Index> index = Index::open(path, false);
  if (!index) return index.error();
  const auto index_of = [&](std::string_view id) {
    return shard_of(id, settings.shards) == settings.shard ? &*index : nullptr;
  };
  Result<Totals> totals = put_in_order(*manifest, index_of, path,
                                       out + "/" + report_name(settings.shard, settings.shards));
  if (!totals) return totals.error();
  ending.totals = *totals;
  return ending;
}

namespace {

// The number of shards of the indices in a folder; 0: there are none.
Result<int> shards_in(const std::string& folder) {
  int shards = 0;
  std::error_code failed;
  for (const fs::directory_entry& file : fs::directory_iterator(folder, failed)) {
    const std::string name = file.path().filename().string();
    int shard = 0, all = 0;
    if (std::sscanf(name.c_str(), "index.%d-of-%d.tsv", &shard, &all) != 2) continue;
    if (name != index_name(shard, all)) continue;
    if (shards != 0 && shards != all) {
      return make_error(Code::invalid_argument, "there are shards of " + std::to_string(shards) +
                                                    " and of " + std::to_string(all) +
                                                    "; remove those that are not wanted")
          .in_file(folder);
    }
    shards = all;
  }
  if (shards < 1) return make_error(Code::not_found, "there are no shards to join").in_file(folder);
  return shards;
}

Result<void> check_outputs(const Index& index, Manifest& manifest, const Settings& settings,
                           int shard, int shards) {
  if (auto begun = manifest.rewind(); !begun) return begun;
  for (;;) {
    const Result<std::optional<Row>> row = manifest.next();
    if (!row) return row.error();
    if (!*row) return {};
    const std::string id((*row)->at("id"));
    if (shard_of(id, shards) != shard) continue;
    const std::string again = "; run shard " + std::to_string(shard) + "/" +
                              std::to_string(shards) + " again with --resume";
    const Index::Known* known = index.find(id);
    if (known == nullptr) {
      return make_error(Code::not_found, "clip \"" + id + "\" is not done" + again)
          .in_file(index_name(shard, shards));
    }
    const Result<std::string> line = index.line(*known);
    if (!line) return line.error();
    const auto entry = read_index_line(std::string_view(*line).substr(0, line->size() - 1));
    if (!entry || !entry->good || !settings.shared.store.empty()) continue;
    std::uint64_t bytes = 0;
    for (const std::string& name : entry->outputs) {
      std::error_code missing;
      const std::uint64_t size = fs::file_size(settings.shared.out + "/" + name, missing);
      if (missing) return make_error(Code::not_found, "is missing" + again).in_file(name);
      bytes += size;
    }
    if (bytes != entry->bytes) {
      return make_error(Code::io, "its outputs have another size than they had" + again)
          .in_file(id);
    }
  }
}

}  // namespace

Result<Totals> join_batch(const Settings& settings) {
  const std::string& out = settings.shared.out;
  Result<Manifest> manifest = Manifest::open(settings.manifest, settings.form, settings.defaults);
  if (!manifest) return manifest.error();
  std::vector<std::string> problems;
  if (auto rows = check_manifest(*manifest, 1, 1, problems); !rows) return rows.error();
  if (!problems.empty()) return all_of(problems);
  const Result<int> shards = shards_in(out);
  if (!shards) return shards.error();
  std::vector<Index> all;
  for (int shard = 1; shard <= *shards; ++shard) {
    Result<Index> index = Index::open(out + "/" + index_name(shard, *shards), false);
    if (!index) return index.error();
    all.push_back(*std::move(index));
    auto good = check_outputs(all.back(), *manifest, settings, shard, *shards);
    if (!good) return good.error();
  }
  return put_in_order(
      *manifest, [&](std::string_view id) { return &all[std::size_t(shard_of(id, *shards) - 1)]; },
      out + "/index.tsv", out + "/report.html");
}

}  // namespace animeme::batch
