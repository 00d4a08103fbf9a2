// Streaming through the program: one sends, the other receives, on this machine.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/formats/media/live/ports.h"
#include "tests/formats/media/live/rtp_sockets.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tools/formats/media/container.h"

namespace animeme::test {

/// What a receiver may take, whatever a sender says. A sanitizer has memory of its own.
#if defined(__SANITIZE_ADDRESS__)
#define ANIMEME_TEST_ADDRESSES 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ANIMEME_TEST_ADDRESSES 1
#endif
#endif
#ifdef ANIMEME_TEST_ADDRESSES
inline constexpr double kMostMegabytes = 900;
#else
inline constexpr double kMostMegabytes = 300;
#endif

/// Of a file; 0 if it is not there.
inline std::uintmax_t size_of(const std::string& path) {
  std::error_code none;
  const auto size = std::filesystem::file_size(path, none);
  return none ? 0 : size;
}

/// The program running beside the test; ended with it.
class Running {
 public:
  Running(std::vector<std::string> arguments, const std::string& out, const std::string& err,
          int input = -1) {
    arguments.insert(arguments.begin(), std::string(test::kBinaryFolder) + "/bin/animeme");
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    if (input >= 0) ::dup2(input, STDIN_FILENO);
    ::dup2(::open(out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    if (!code_) ::kill(pid_, SIGKILL);
    (void)wait();
  }
  void signal(int number) const { ::kill(pid_, number); }
  int wait() {
    if (code_) return *code_;
    int status = 0;
    rusage used{};
    ::wait4(pid_, &status, 0, &used);
    peak_mb_ = double(used.ru_maxrss) / 1024;
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return *code_;
  }

  /// Most memory that it ever had, after wait().
  double peak_mb() const { return peak_mb_; }

 private:
  pid_t pid_;
  std::optional<int> code_;
  double peak_mb_ = 0;
};

template <class Condition>
bool wait_for(Condition condition, int seconds = 60) {
  for (int i = 0; i < seconds * 50; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

/// A talking face of about two seconds with its sound.
class Streams : public testing::Test {
 protected:
  void SetUp() override {
    const auto made = animeme({"speak", "--text", "Hello my old friend, how are you?",
                               "--intra-seconds", "0.4", "-o", dir / "talk.mp4"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    url = "rtp://127.0.0.1:" + std::to_string(free_ports());
  }
  // Writes the session description as the sender will: a first run without a receiver.
  std::vector<std::string> sender(std::vector<std::string> more) const {
    std::vector<std::string> all = {"stream", "--to", url, "--sdp", dir / "talk.sdp"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  bool described() const { return std::filesystem::exists(dir / "talk.sdp"); }

  TempDir dir;
  std::string url;
};

inline media::Container container(const std::string& path) {
  auto read = media::read_container(path);
  EXPECT_TRUE(read) << read.error().describe();
  return read ? std::move(*read) : media::Container{};
}

}  // namespace animeme::test
