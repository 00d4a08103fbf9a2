/// @file
/// Forked worker processes that answer messages, to use all cores with libraries that have global
/// state (one voice, one standard output). A worker that crashes is replaced.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::batch {

/// A pool of workers. Not thread safe; forks, so no other thread may run.
class Workers {
 public:
  /// Answers a message; runs in the worker.
  using Work = std::function<std::string(std::string_view message, std::size_t worker)>;
  /// `work` runs in the workers, for one message at a time.
  Workers(std::size_t count, Work work) : work_(std::move(work)), all_(count) {}
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();  ///< ends them

  /// An idle worker; nullopt: all are busy.
  std::optional<std::size_t> idle() const;
  bool busy() const;  ///< whether any worker is busy
  /// Sends a message to an idle worker, which is started if necessary. Errors: io.
  Result<void> give(std::size_t worker, std::string_view message);

  /// An answer of a worker.
  struct Answer {
    std::size_t worker = 0;  ///< the worker
    std::string message;     ///< its answer
    std::string crash;       ///< how it crashed; empty: it did not
  };
  /// The next answer, or nullopt after `milliseconds`.
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
