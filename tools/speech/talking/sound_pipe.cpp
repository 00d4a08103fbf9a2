#include "tools/speech/talking/sound_pipe.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <span>
#include <thread>
#include <utility>

namespace animeme::speech {

namespace {

constexpr double kKeptAhead = 0.5;  // seconds of sound that are read before they are wanted
constexpr int kWaitMs = 50;         // for sound; then a wish to stop is looked for

}  // namespace

struct SoundPipe::Impl {
  int descriptor;
  SoundBytes bytes;
  std::mutex mutex;
  std::condition_variable came, room;
  std::deque<float> samples;
  std::optional<Error> error;
  int rate = 0;
  unsigned discarded = 0;     // calls of discard()
  std::size_t old_bytes = 0;  // in the pipe, to be dropped when they are read
  bool ended = false;
  std::atomic<bool> stop = false;
  std::thread thread;

  bool full() const { return rate > 0 && double(samples.size()) > kKeptAhead * rate; }

  void read() {
    std::array<std::uint8_t, 4096> block;
    std::vector<float> some;
    while (!stop) {
      {
        std::unique_lock lock(mutex);
        room.wait(lock, [this] { return stop || !full(); });
      }
      pollfd wanted{descriptor, POLLIN, 0};
      const int ready = ::poll(&wanted, 1, kWaitMs);
      if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
      unsigned read_at = 0;  // how often was discarded before
      ssize_t got = -1;
      {
        const std::lock_guard lock(mutex);  // what discard() counts is not being read
        read_at = discarded;
        if (ready > 0) got = ::read(descriptor, block.data(), block.size());
      }
      if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      some.clear();
      Result<void> good;
      if (got > 0) good = bytes.push(std::span(block).first(std::size_t(got)), some);
      const std::lock_guard lock(mutex);
      rate = bytes.sample_rate();
      if (read_at != discarded) {
        some.clear();  // it came before
      } else if (old_bytes > 0 && got > 0) {
        const auto old = std::min(old_bytes, std::size_t(got));
        old_bytes -= old;
        some.erase(some.begin(),
                   some.begin() + std::ptrdiff_t(some.size() * old / std::size_t(got)));
      }
      samples.insert(samples.end(), some.begin(), some.end());
      if (got < 0) error = make_error(Code::io, "the sound cannot be read any more");
      if (!good) error = good.error();
      ended = got <= 0 || !good;
      came.notify_all();
      if (ended) return;
    }
  }
};

SoundPipe::SoundPipe(int descriptor, std::optional<BareSound> bare)
    : impl_(new Impl{.descriptor = descriptor, .bytes = SoundBytes(bare)}) {
  impl_->thread = std::thread([raw = impl_.get()] { raw->read(); });
}

SoundPipe::~SoundPipe() {
  {
    const std::lock_guard lock(impl_->mutex);  // so that it does not fall asleep just now
    impl_->stop = true;
  }
  impl_->room.notify_all();
  impl_->thread.join();
}

Result<int> SoundPipe::wait_for_rate() {
  std::unique_lock lock(impl_->mutex);
  impl_->came.wait(lock, [this] { return impl_->rate > 0 || impl_->ended; });
  if (impl_->error) return *impl_->error;
  return impl_->rate;
}

int SoundPipe::rate_so_far() {
  const std::lock_guard lock(impl_->mutex);
  return impl_->rate;
}

std::vector<float> SoundPipe::take(std::size_t most) {
  const std::lock_guard lock(impl_->mutex);
  std::deque<float>& all = impl_->samples;
  const auto count = std::ptrdiff_t(std::min(most, all.size()));
  std::vector<float> some(all.begin(), all.begin() + count);
  all.erase(all.begin(), all.begin() + count);
  if (count > 0) impl_->room.notify_all();
  return some;
}

bool SoundPipe::over() {
  const std::lock_guard lock(impl_->mutex);
  return impl_->ended && impl_->samples.empty();
}

std::size_t SoundPipe::waiting() {
  const std::lock_guard lock(impl_->mutex);
  return impl_->samples.size();
}

void SoundPipe::discard() {
  const std::lock_guard lock(impl_->mutex);
  impl_->samples.clear();
  ++impl_->discarded;
  int sent = 0;
  impl_->old_bytes =
      ::ioctl(impl_->descriptor, FIONREAD, &sent) == 0 && sent > 0 ? std::size_t(sent) : 0;
  impl_->room.notify_all();
}

std::optional<Error> SoundPipe::take_error() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->error, std::nullopt);
}

}  // namespace animeme::speech
