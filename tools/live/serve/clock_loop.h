/// @file
/// Runs many timed tasks on a few threads.
///
///     ClockLoop loop(media::steady_clock(), {.threads = 2});
///     loop.add(head);              // head->step() is called at the instants that it returns
///     loop.wake(head.get());       // ... or now
///     loop.remove(head.get());
#pragma once

#include <condition_variable>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "tools/formats/media/live/pacer.h"

/// Many talking heads in one process on one port.
namespace animeme::serve {

/// A task that runs in steps, never two at a time.
class Beat {
 public:
  virtual ~Beat() = default;
  /// Runs a step. Returns the instant of the next one, on the clock of the loop; infinity: when
  /// woken.
  virtual double step() = 0;
};

/// All settings of ClockLoop.
struct LoopOptions {
  int threads = 1;  ///< 1..64
  /// Instants are rounded up to multiples of this many seconds, to combine wake-ups; 0..1.
  double grain = 0.002;
};

/// Each thread runs the task that is due first. Thread safe, except destruction.
class ClockLoop {
 public:
  /// The clock must outlive the loop. std::system_error if no thread can be started.
  ClockLoop(media::Clock& clock, const LoopOptions& options);
  ~ClockLoop();  ///< waits for running steps
  ClockLoop(const ClockLoop&) = delete;
  ClockLoop& operator=(const ClockLoop&) = delete;

  void add(std::shared_ptr<Beat> beat);  ///< its first step is due now
  void wake(const Beat* beat);           ///< makes a step due now; ignores unknown tasks
  /// Removes a task and waits for its running step. Do not call from a step.
  void remove(const Beat* beat);

 private:
  struct Entry {
    std::shared_ptr<Beat> beat;
    double due = 0;
    bool running = false, woken = false, removed = false;
  };
  using Due = std::pair<double, const Beat*>;

  void run();
  void schedule(const Beat* key, Entry& entry, double instant);
  void make_step(std::unique_lock<std::mutex>& lock);

  media::Clock& clock_;
  const double grain_;
  std::mutex mutex_;  // for what follows
  std::condition_variable changed_, stepped_;
  std::map<const Beat*, Entry> entries_;
  std::set<Due> due_;
  double armed_ = std::numeric_limits<double>::infinity();  // a thread sleeps until then
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace animeme::serve
