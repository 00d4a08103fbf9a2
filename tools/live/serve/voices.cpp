#include "tools/live/serve/voices.h"

#include <exception>
#include <future>
#include <system_error>
#include <utility>

#include "tools/formats/common/text.h"

namespace animeme::serve {
namespace {

constexpr std::size_t kMostMakers = 200;  // what is kept of voices

}  // namespace

Voices::Voices(MakerOf maker_of) : maker_of_(std::move(maker_of)), thread_([this] { run(); }) {}

Voices::~Voices() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    jobs_.clear();
    slow_jobs_.clear();
  }
  changed_.notify_all();
  thread_.join();
  for (std::thread& thread : slow_) thread.join();
}

void Voices::post(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
    jobs_.push_back(std::move(job));
  }
  changed_.notify_all();
}

void Voices::post_slow(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
    slow_jobs_.push_back(std::move(job));
    if (int(slow_jobs_.size()) > idle_ && slow_.size() < kMostSlow) {
      try {
        slow_.emplace_back([this] { run_slow(); });
      } catch (const std::system_error&) {
        // Those that there are do it.
        if (slow_.empty()) {
          jobs_.push_back(std::move(slow_jobs_.back()));
          slow_jobs_.pop_back();
        }
      }
    }
  }
  changed_.notify_all();
}

void Voices::run_slow() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (slow_jobs_.empty()) {
      ++idle_;
      changed_.wait(lock);
      --idle_;
      continue;
    }
    std::function<void()> job = std::move(slow_jobs_.front());
    slow_jobs_.pop_front();
    lock.unlock();
    job();
    job = nullptr;
    lock.lock();
  }
}

void Voices::post_first(std::function<void()> job) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
    jobs_.push_front(std::move(job));
  }
  changed_.notify_all();
}

Result<speech::LineMaker> Voices::find(const voice::VoiceOptions& options) {
  const std::string key =
      tools::format("%s %d %d", options.language.c_str(), options.words_per_minute, options.pitch);
  const auto known = makers_.find(key);
  if (known != makers_.end()) return known->second;
  Result<speech::LineMaker> made = maker_of_(options);
  if (!made) return made;
  if (makers_.size() >= kMostMakers) makers_.clear();
  makers_.emplace(key, *made);
  return made;
}

Result<speech::LineMaker> Voices::maker(const voice::VoiceOptions& options) {
  auto promise = std::make_shared<std::promise<Result<speech::LineMaker>>>();
  std::future<Result<speech::LineMaker>> made = promise->get_future();
  post_first([this, options, promise = std::move(promise)] {
    try {
      promise->set_value(find(options));
    } catch (const std::exception& problem) {
      promise->set_value(make_error(Code::out_of_range, problem.what()));
    }
  });
  try {
    return made.get();
  } catch (const std::future_error&) {
    return make_error(Code::io, "the server is ending");
  }
}

void Voices::run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (jobs_.empty()) {
      changed_.wait(lock);
      continue;
    }
    std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    job();
    job = nullptr;
    lock.lock();
  }
}

}  // namespace animeme::serve
