/// @file
/// Child processes that run side by side, each with its own time limit: programs, or functions of
/// ours in a forked copy, so that nothing a child does can end the parent.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::tools {

/// What a child is to do: run `arguments`, or call `work` if there are none.
struct ChildJob {
  std::vector<std::string> arguments;                   ///< program and arguments; empty: `work`
  std::function<int()> work;                            ///< its value is the exit code
  std::string in;                                       ///< read by it; empty: nothing to read
  std::string out,                                      ///< empty: thrown away
      err;                                              ///< likewise
  std::uint64_t most_bytes = std::uint64_t(256) << 20;  ///< that each of its files may have
};

/// How a child ended.
struct ChildEnd {
  /// Three ways to end.
  enum class How : std::uint8_t { exited, crashed, timed_out };
  How how = How::exited;  ///< which of them
  int code = 0;           ///< exit code, or the number of the signal
  double seconds = 0;     ///< wall clock
};

/// Some children at once. Not thread safe. Jobs with `work` want that no other thread runs: they
/// fork and go on.
class Children {
 public:
  /// `timeout_seconds` for each child.
  explicit Children(double timeout_seconds) : timeout_(timeout_seconds) {}
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;
  /// Ends what still runs.
  ~Children();

  /// Starts one. Its files have a limit, and it leaves no core file.
  /// `id` comes back from wait(). Errors, io: it cannot be started.
  Result<void> start(std::size_t id, const ChildJob& job);
  /// Started and not yet given out by wait().
  std::size_t running() const { return running_.size(); }

  /// A child that has ended.
  struct Finished {
    std::size_t id = 0;  ///< as given to start()
    ChildEnd end;        ///< how
  };
  /// Waits until one has ended or was stopped at its time limit, with all the children that it had
  /// itself. running() must not be 0.
  Finished wait();
  /// The same, but nothing if all still run after `seconds`.
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
