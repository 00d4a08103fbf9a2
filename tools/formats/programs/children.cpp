#include "tools/formats/programs/children.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

namespace animeme::tools {
namespace {

Error cannot(const std::string& what) {
  return make_error(Code::io, what + ": " + std::strerror(errno));
}

void put_file(const char* path, int flags, int descriptor) {
  const int file = ::open(*path == '\0' ? "/dev/null" : path, flags, 0600);
  if (file < 0) ::_exit(126);
  ::dup2(file, descriptor);
  if (file > STDERR_FILENO) ::close(file);
}

void limit(int what, rlim_t most) {
  const rlimit set{most, most};
  ::setrlimit(what, &set);
}

[[noreturn]] void run_child(const ChildJob& job, std::vector<char*>& argv, int report) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  put_file(job.in.c_str(), O_RDONLY, STDIN_FILENO);
  put_file(job.out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
  put_file(job.err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, rlim_t(job.most_bytes));
  if (job.arguments.empty()) {
    ::close(report);
    ::_exit(job.work());
  }
  ::execvp(argv.front(), argv.data());
  const int error = errno;
  const ssize_t ignored = ::write(report, &error, sizeof error);
  static_cast<void>(ignored);
  ::_exit(127);
}

}  // namespace

Children::~Children() {
  for (const Child& child : running_) {
    ::kill(-child.pid, SIGKILL);
    ::waitpid(child.pid, nullptr, 0);
  }
}

Result<void> Children::start(std::size_t id, const ChildJob& job) {
  std::vector<char*> argv;
  for (const std::string& argument : job.arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));  // execvp takes them so and leaves them
  }
  argv.push_back(nullptr);
  std::array<int, 2> report{};
  if (::pipe2(report.data(), O_CLOEXEC) != 0) return cannot("no pipe for a child process");
  const Clock::time_point start = Clock::now();
  const pid_t pid = ::fork();
  if (pid == 0) run_child(job, argv, report[1]);
  ::close(report[1]);
  if (pid < 0) {
    ::close(report[0]);
    return cannot("no child process can be started");
  }
  ::setpgid(pid, pid);  // both sides do it, so that it is done before either needs it
  int error = 0;
  ssize_t count = 0;
  do {
    count = ::read(report[0], &error, sizeof error);  // ends when the program runs
  } while (count < 0 && errno == EINTR);
  ::close(report[0]);
  if (count == sizeof error) {
    ::waitpid(pid, nullptr, 0);
    errno = error;
    return cannot(job.arguments.front() + " cannot be started");
  }
  running_.push_back({id, pid, start});
  return {};
}

// The first that has ended or has to.
std::optional<Children::Finished> Children::look() {
  for (std::size_t i = 0; i < running_.size(); ++i) {
    const Child child = running_[i];
    siginfo_t info{};
    const int known = ::waitid(P_PID, id_t(child.pid), &info, WEXITED | WNOHANG | WNOWAIT);
    const bool ended = known == 0 && info.si_pid == child.pid;
    const double seconds = std::chrono::duration<double>(Clock::now() - child.start).count();
    if (!ended && seconds < timeout_) continue;
    ::kill(-child.pid, SIGKILL);  // also what it left running
    int status = 0;
    while (::waitpid(child.pid, &status, 0) < 0 && errno == EINTR) {
    }
    running_.erase(running_.begin() + std::ptrdiff_t(i));
    Finished finished{child.id, {}};
    finished.end.seconds = seconds;
    if (!ended) {
      finished.end.how = ChildEnd::How::timed_out;
    } else if (WIFSIGNALED(status)) {
      finished.end.how = ChildEnd::How::crashed;
      finished.end.code = WTERMSIG(status);
    } else {
      finished.end.code = WEXITSTATUS(status);
    }
    return finished;
  }
  return std::nullopt;
}

Children::Finished Children::wait() {
  for (;;) {
    if (const auto finished = look()) return *finished;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::optional<Children::Finished> Children::wait_for(double seconds) {
  const Clock::time_point start = Clock::now();
  for (;;) {
    if (const auto finished = look()) return finished;
    if (std::chrono::duration<double>(Clock::now() - start).count() >= seconds) return std::nullopt;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::string signal_text(int signal) {
  const char* name = ::strsignal(signal);
  return "signal " + std::to_string(signal) + " (" + (name != nullptr ? name : "?") + ")";
}

}  // namespace animeme::tools
