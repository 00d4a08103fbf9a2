#include "tools/live/serve/clock_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace animeme::serve {
namespace {

constexpr double kLongestWait = 3600;  // seconds

}  // namespace

ClockLoop::ClockLoop(media::Clock& clock, const LoopOptions& options)
    : clock_(clock), grain_(options.grain) {
  for (int i = 0; i < std::clamp(options.threads, 1, 64); ++i) {
    threads_.emplace_back([this] { run(); });
  }
}

ClockLoop::~ClockLoop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ClockLoop::schedule(const Beat* key, Entry& entry, double instant) {
  due_.erase({entry.due, key});
  entry.due = instant;
  if (std::isfinite(instant)) due_.emplace(instant, key);
}

void ClockLoop::add(std::shared_ptr<Beat> beat) {
  const std::lock_guard lock(mutex_);
  const Beat* key = beat.get();
  Entry& entry = entries_[key];
  entry.beat = std::move(beat);
  schedule(key, entry, clock_.now());
  changed_.notify_one();
}

void ClockLoop::wake(const Beat* beat) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(beat);
  if (found == entries_.end()) return;
  if (found->second.running) {
    found->second.woken = true;
  } else {
    schedule(beat, found->second, clock_.now());
    changed_.notify_one();
  }
}

void ClockLoop::remove(const Beat* beat) {
  std::unique_lock lock(mutex_);
  const auto found = entries_.find(beat);
  if (found == entries_.end()) return;
  found->second.removed = true;
  stepped_.wait(lock, [&] { return !found->second.running; });
  due_.erase({found->second.due, beat});
  const std::shared_ptr<Beat> last = std::move(found->second.beat);
  entries_.erase(found);
  lock.unlock();  // it may end here
}

// Of the one that is due first.
void ClockLoop::make_step(std::unique_lock<std::mutex>& lock) {
  const Beat* key = due_.begin()->second;
  Entry& entry = entries_.at(key);  // stays where it is; remove() waits for its step
  due_.erase(due_.begin());
  entry.running = true;
  const std::shared_ptr<Beat> beat = entry.beat;
  // What is due later this thread comes back for: a step is short.
  if (!due_.empty() && due_.begin()->first <= clock_.now()) changed_.notify_one();
  lock.unlock();
  double next = beat->step();
  if (grain_ > 0 && std::isfinite(next)) next = std::ceil(next / grain_) * grain_;
  lock.lock();
  entry.running = false;
  if (entry.removed) {
    stepped_.notify_all();
    return;
  }
  if (std::exchange(entry.woken, false)) next = clock_.now();
  schedule(key, entry, next);
}

void ClockLoop::run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (due_.empty()) {
      changed_.wait(lock);
      continue;
    }
    const double first = due_.begin()->first, wait = first - clock_.now();
    if (wait <= 0) {
      make_step(lock);
    } else if (armed_ <= first) {
      changed_.wait(lock);  // another thread sleeps that long
    } else {
      armed_ = first;
      changed_.wait_for(lock, std::chrono::duration<double>(std::min(wait, kLongestWait)));
      armed_ = std::numeric_limits<double>::infinity();
    }
  }
}

}  // namespace animeme::serve
