#include "tools/app/batch/batch.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>

#include "tools/app/batch/workers.h"
#include "tools/formats/files/file_lock.h"

namespace animeme::batch {

namespace fs = std::filesystem;

namespace {

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
      const std::string said = last_said(settings_.shared, answer.worker);
      outcome.entry.error = answer.crash + (said.empty() ? "" : ": " + said);
      outcome.entry.version = settings_.shared.version;
    }
    ++standing.done;
    for (std::size_t i = 0; i < tools::kSteps; ++i) {
      standing.costs[i].cpu_seconds += outcome.costs[i].cpu_seconds;
      standing.costs[i].bytes += outcome.costs[i].bytes;
    }
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

Result<Ending> run_batch(const Settings& given, const Watch& watch) {
  Settings settings = given;
  const std::string out = settings.shared.out;
  Result<Manifest> manifest = Manifest::open(settings.manifest, settings.form, settings.defaults);
  if (!manifest) return manifest.error();
  std::vector<std::string> problems;
  Result<std::uint64_t> rows = check_manifest(*manifest, settings.shard, settings.shards, problems);
  if (!rows) return rows.error();
  if (!problems.empty()) return problem_error(problems);

  std::error_code failed;
  fs::create_directories(out, failed);
  const std::string path = out + "/" + index_name(settings.shard, settings.shards);
  Result<tools::FileLock> lock = take_lock(path);
  if (!lock) return lock.error();
  if (!settings.resume && fs::exists(path, failed)) {
    return make_error(
               Code::invalid_argument,
               "the folder already has a batch; continue it with --resume, or give another folder")
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

}  // namespace animeme::batch
