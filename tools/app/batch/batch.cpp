#include "tools/app/batch/batch.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/formats/files/file_lock.h"
#include "tools/formats/programs/children.h"

namespace animeme::batch {

namespace {

// A pool of workers. Not thread safe; forks, so no other thread may run.
class Workers {
 public:
  // Answers a message; runs in the worker.
  using Work = std::function<std::string(std::string_view message, std::size_t worker)>;
  // `work` runs in the workers, for one message at a time.
  Workers(std::size_t count, Work work) : work_(std::move(work)), all_(count) {}
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();  // ends them

  // An idle worker; nullopt: all are busy.
  std::optional<std::size_t> idle() const;
  bool busy() const;  // whether any worker is busy
  // Sends a message to an idle worker, which is started if necessary. Errors: io.
  Result<void> give(std::size_t worker, std::string_view message);

  // An answer of a worker.
  struct Answer {
    std::size_t worker = 0;  // the worker
    std::string message;     // its answer
    std::string crash;       // how it crashed; empty: it did not
  };
  // The next answer, or nullopt after `milliseconds`.
  std::optional<Answer> wait(int milliseconds);

 private:
  struct One {
    int pid = 0, socket = -1;  // pid 0: not started
    bool busy = false;
  };
  Result<void> start(std::size_t worker);
  std::string stop(One& one);

  Work work_;
  std::vector<One> all_;
};

bool send_all(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(std::size_t(count));
  }
  return true;
}

bool receive_all(int socket, char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t count = ::recv(socket, bytes, size, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= std::size_t(count);
  }
  return true;
}

bool send_message(int socket, std::string_view message) {
  const std::uint64_t size = message.size();
  return send_all(socket, {reinterpret_cast<const char*>(&size), sizeof size}) &&
         send_all(socket, message);
}

bool receive_message(int socket, std::string& message) {
  std::uint64_t size = 0;
  if (!receive_all(socket, reinterpret_cast<char*>(&size), sizeof size)) return false;
  message.resize(size);
  return receive_all(socket, message.data(), message.size());
}

// Ctrl-C goes to the whole group: what runs is finished all the same. It ends with its parent.
[[noreturn]] void serve(int socket, int parent, std::size_t worker, const Workers::Work& work) {
  sigset_t blocked;
  sigemptyset(&blocked);
  for (const int one : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&blocked, one);
  ::sigprocmask(SIG_BLOCK, &blocked, nullptr);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (null >= 0) ::dup2(null, STDIN_FILENO);
  std::string message;
  int code = 0;
  try {
    while (code == 0 && receive_message(socket, message)) {
      code = send_message(socket, work(message, worker)) ? 0 : 1;
    }
  } catch (const std::exception&) {
    code = 1;
  }
  ::_exit(code);
}

Workers::~Workers() {
  for (One& one : all_) stop(one);
}

std::optional<std::size_t> Workers::idle() const {
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!all_[i].busy) return i;
  }
  return std::nullopt;
}

bool Workers::busy() const {
  for (const One& one : all_) {
    if (one.busy) return true;
  }
  return false;
}

Result<void> Workers::start(std::size_t worker) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return make_error(Code::io, std::string("no worker can be started: ") + std::strerror(errno));
  }
  std::cout.flush();
  std::fflush(nullptr);
  const int parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    // Theirs are not ours: one that keeps a socket open would hide the end of its neighbour.
    for (const One& one : all_) {
      if (one.socket >= 0) ::close(one.socket);
    }
    ::close(ends[0]);
    serve(ends[1], parent, worker, work_);
  }
  ::close(ends[1]);
  if (child < 0) {
    ::close(ends[0]);
    return make_error(Code::io, std::string("no worker can be started: ") + std::strerror(errno));
  }
  all_[worker] = {child, ends[0], false};
  return {};
}

std::string Workers::stop(One& one) {
  if (one.pid == 0) return {};
  ::close(one.socket);
  int status = 0;
  while (::waitpid(one.pid, &status, 0) < 0 && errno == EINTR) {
  }
  one = {};
  return WIFSIGNALED(status) ? "crashed by " + tools::signal_text(WTERMSIG(status)) : "ended early";
}

Result<void> Workers::give(std::size_t worker, std::string_view message) {
  if (all_[worker].pid == 0) {
    if (auto started = start(worker); !started) return started;
  }
  all_[worker].busy = true;  // wait() reports a worker that ended
  send_message(all_[worker].socket, message);
  return {};
}

std::optional<Workers::Answer> Workers::wait(int milliseconds) {
  std::vector<pollfd> looked;
  std::vector<std::size_t> which;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!all_[i].busy) continue;
    looked.push_back({all_[i].socket, POLLIN, 0});
    which.push_back(i);
  }
  if (looked.empty() || ::poll(looked.data(), looked.size(), milliseconds) <= 0) return {};
  for (std::size_t i = 0; i < looked.size(); ++i) {
    if (looked[i].revents == 0) continue;
    One& one = all_[which[i]];
    Answer answer{which[i], {}, {}};
    one.busy = false;
    if (!receive_message(one.socket, answer.message)) answer.crash = stop(one);
    return answer;
  }
  return {};
}

}  // namespace

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
  Result<Manifest> manifest = Manifest::open(settings.manifest, settings.form, settings.defaults,
                                             settings.allow_commands, settings.dialect);
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
  // Made in the folder that the next run removes, so that nothing of a killed one stays.
  fs::create_directories(settings.shared.stage, failed);
  const std::string report = report_name(settings.shard, settings.shards);
  const std::string staged =
      settings.shared.stage + "/" + index_name(settings.shard, settings.shards);
  const std::string staged_report = settings.shared.stage + "/" + report;
  Result<Totals> totals = put_in_order(*manifest, index_of, staged, staged_report);
  if (!totals) return totals.error();
  if (settings.report) fs::rename(staged_report, out + "/" + report, failed);
  if (!failed) fs::rename(staged, path, failed);
  if (failed) {
    return make_error(Code::io, "cannot be written: " + failed.message()).in_file(path);
  }
  fs::remove_all(settings.shared.stage, failed);
  ending.totals = *totals;
  return ending;
}

}  // namespace animeme::batch
