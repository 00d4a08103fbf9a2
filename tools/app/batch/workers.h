/// @file
/// Forked copies of this process that answer messages: work on all cores for libraries that keep
/// one voice, one standard output and one current error a process. A crash is the end of one of
/// them, which is replaced.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::batch {

/// Some workers. Not thread safe; forks, so no other thread may run.
class Workers {
 public:
  /// A message in, an answer out; runs in the copy.
  using Work = std::function<std::string(std::string_view message, std::size_t worker)>;
  /// `work` is run in the copies, for one message after the other.
  Workers(std::size_t count, Work work) : work_(std::move(work)), all_(count) {}
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();  ///< ends them

  /// A worker that has nothing to do; nothing: all are busy.
  std::optional<std::size_t> idle() const;
  bool busy() const;  ///< whether any is at work
  /// Gives a message to an idle worker, which is started if need be. Errors: io.
  Result<void> give(std::size_t worker, std::string_view message);

  /// What a worker answered.
  struct Answer {
    std::size_t worker = 0;  ///< which
    std::string message;     ///< its answer
    std::string crash;       ///< how it ended instead; empty: it did not
  };
  /// The next answer, or nothing after `milliseconds`.
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

}  // namespace animeme::batch
