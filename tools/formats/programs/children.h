/// @file
/// Parallel child processes, each with a time limit: programs, or functions in a forked copy,
/// isolated from the parent.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// The job of a child: run `arguments`, or call `work` if there are none.
struct ChildJob {
  std::vector<std::string> arguments;                   ///< program and arguments; empty: `work`
  std::function<int()> work;                            ///< returns the exit code
  std::string in;                                       ///< standard input; empty: none
  std::string out,                                      ///< standard output; empty: discarded
      err;                                              ///< likewise
  std::uint64_t most_bytes = std::uint64_t(256) << 20;  ///< maximum size of each of its files
};

/// How a child ended.
struct ChildEnd {
  /// Three ways to end.
  enum class How : std::uint8_t { exited, crashed, timed_out };
  How how = How::exited;  ///< which of them
  int code = 0;           ///< exit code, or the number of the signal
  double seconds = 0;     ///< wall clock
};

/// Runs several children. Not thread safe. Jobs with `work` require that no other thread runs,
/// since they fork without exec.
class Children {
 public:
  /// `timeout_seconds` for each child.
  explicit Children(double timeout_seconds) : timeout_(timeout_seconds) {}
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;
  /// Kills running children.
  ~Children();

  /// Starts a child with limited file sizes and without core dumps. wait() returns `id`. Errors: io
  /// (cannot be started).
  Result<void> start(std::size_t id, const ChildJob& job);
  /// Number of children started and not yet returned by wait().
  std::size_t running() const { return running_.size(); }

  /// A child that has ended.
  struct Finished {
    std::size_t id = 0;  ///< of start()
    ChildEnd end;        ///< how it ended
  };
  /// Waits until one has ended or was killed at its time limit, together with its own children.
  /// running() must not be 0.
  Finished wait();
  /// The same; nullopt if all still run after `seconds`.
  std::optional<Finished> wait_for(double seconds);

 private:
  using Clock = std::chrono::steady_clock;
  struct Child {
    std::size_t id;
    int pid;
    Clock::time_point start;
  };

  std::optional<Finished> look();

  double timeout_;
  std::vector<Child> running_;
};

/// "signal 11 (Segmentation fault)"
std::string signal_text(int signal);

}  // namespace animeme::tools
