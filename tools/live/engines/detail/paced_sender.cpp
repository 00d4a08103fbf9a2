#include "tools/live/engines/detail/paced_sender.h"

#include <chrono>
#include <utility>

namespace animeme::engines {
namespace {

using SteadyClock = std::chrono::steady_clock;

SteadyClock::time_point point_of(double instant) {
  const std::chrono::duration<double> since(instant);
  return SteadyClock::time_point(std::chrono::ceil<SteadyClock::duration>(since));
}

}  // namespace

double PacedSender::now() {
  return std::chrono::duration<double>(SteadyClock::now().time_since_epoch()).count();
}

PacedSender::~PacedSender() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PacedSender::put(const Datagrams& datagrams) {
  for (const auto& datagram : datagrams) {
    if (auto sent = socket_.send(datagram, to_); !sent && !error_) error_ = sent.error();
  }
}

Result<void> PacedSender::send(double instant, Datagrams datagrams) {
  {
    const std::lock_guard lock(mutex_);
    if (error_) return *error_;
    if (waiting_.empty() && instant <= now()) {
      put(datagrams);
      return error_ ? Result<void>(*error_) : Result<void>();
    }
    waiting_.push_back({instant, std::move(datagrams)});
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  changed_.notify_all();
  return {};
}

void PacedSender::run() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    if (waiting_.empty()) {
      changed_.wait(lock);
      continue;
    }
    const double instant = waiting_.front().instant;
    if (instant > now()) {
      changed_.wait_until(lock, point_of(instant));
      continue;
    }
    put(waiting_.front().datagrams);
    waiting_.pop_front();
    if (waiting_.empty()) changed_.notify_all();
  }
}

Result<void> PacedSender::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.empty(); });
  return error_ ? Result<void>(*error_) : Result<void>();
}

}  // namespace animeme::engines
