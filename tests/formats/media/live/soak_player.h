// A program that is started, watched and ended again and again.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/folders.h"

namespace animeme::test {

/// Bytes of memory that a process has.
inline std::size_t resident(pid_t pid) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/statm");
  std::size_t all = 0, pages = 0;
  in >> all >> pages;
  return pages * std::size_t(sysconf(_SC_PAGESIZE));
}

class Player {
 public:
  /// `%` in an argument becomes the number of the start.
  Player(std::string name, std::vector<std::string> arguments, std::string folder)
      : name_(std::move(name)), arguments_(std::move(arguments)), folder_(std::move(folder)) {}
  ~Player() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    if (input_ >= 0) close(input_);
  }
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  void start(double now) {
    int pipe[2] = {-1, -1};
    if (pipe2(pipe, O_CLOEXEC) != 0) std::abort();
    const std::string number = std::to_string(++starts_);
    std::vector<std::string> arguments = {std::string(test::kBinaryFolder) + "/bin/animeme"};
    for (std::string argument : arguments_) {
      if (const std::size_t at = argument.find('%'); at != argument.npos) {
        argument.replace(at, 1, number);
      }
      arguments.push_back(argument);
    }
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    talk_ = folder_ + "/" + name_ + number + ".err";
    pid_ = fork();
    if (pid_ == 0) {
      dup2(pipe[0], STDIN_FILENO);
      const int talk = open(talk_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600);
      dup2(talk, STDERR_FILENO);
      dup2(talk, STDOUT_FILENO);
      execv(argv[0], argv.data());
      _exit(127);
    }
    close(pipe[0]);
    if (input_ >= 0) close(input_);
    input_ = pipe[1];
    begun_ = now;
    early_ = 0;
    signal_ = 0;
  }
  void say(const std::string& line) {
    if (pid_ > 0) (void)!write(input_, line.data(), line.size());
  }
  void end(int signal) {
    signal_ = signal;
    if (pid_ > 0) kill(pid_, signal);
  }
  /// True: it runs no more, and has to be started again.
  bool look(double now) {
    if (pid_ <= 0) return true;
    const std::size_t bytes = resident(pid_);
    most_ = std::max(most_, bytes);
    if (now - begun_ > 5 && early_ == 0) early_ = bytes;
    if (early_ > 0 && bytes > early_) growth_ = std::max(growth_, bytes - early_);
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
    pid_ = 0;
    judge(status, now - begun_);
    return true;
  }

  int starts() const { return starts_; }
  int ends() const { return ends_; }
  std::size_t most() const { return most_; }
  std::size_t growth() const { return growth_; }
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  void judge(int status, double age) {
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL && signal_ == SIGKILL) return;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    if (signal_ == 0 && code == 0) {
      ++ends_;  // the sender said goodbye
      return;
    }
    if (signal_ == SIGTERM && (code == 130 || code == 0)) return;
    std::ifstream in(talk_);
    const std::string talk((std::istreambuf_iterator<char>(in)), {});
    // Asked to end before it had learned to listen, or before there was anything to write.
    if (signal_ == SIGTERM && code == -SIGTERM && talk.empty()) return;
    if (signal_ == SIGTERM && code == 3 && age < 10) return;
    if (signal_ == 0 && code == 3 && talk.find("no intra plane came") != talk.npos) {
      ++ends_;  // the sender said goodbye as soon as it was there
      return;
    }
    problems_.push_back(name_ + " ended with " + std::to_string(code) + " after signal " +
                        std::to_string(signal_) + ": " + talk);
  }

  const std::string name_;
  const std::vector<std::string> arguments_;
  const std::string folder_;
  std::string talk_;
  pid_t pid_ = 0;
  int input_ = -1, signal_ = 0;
  int starts_ = 0, ends_ = 0;
  double begun_ = 0;
  std::size_t most_ = 0, early_ = 0, growth_ = 0;
  std::vector<std::string> problems_;
};

}  // namespace animeme::test
