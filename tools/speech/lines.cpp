#include "tools/speech/lines.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "tools/speech/line_cutter_internal.h"

namespace animeme::speech {

namespace {

constexpr std::size_t kMostDone = 4;  // lines that wait: a voice is faster than speech
constexpr std::size_t kShown = 60;    // bytes of a line that is left out

}  // namespace

struct VoiceLines::Impl {
  int descriptor = -1;
  std::array<int, 2> wake = {-1, -1};  // a pipe: closing its end stops the thread
  LineMaker maker;
  media::Clock* clock = nullptr;
  std::size_t number = 0;  // of the line, from 1; the thread's

  std::mutex mutex;  // guards what follows
  std::vector<SpokenLine> done;
  std::vector<std::string> warnings;
  bool over = false;
  std::exception_ptr failure;  // no memory, most likely; goes to who asks whether it is over
  bool stopping = false;
  std::condition_variable room;  // in `done`

  std::thread thread;  // last: it uses all of the above

  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    room.notify_all();
    if (wake[1] >= 0) ::close(wake[1]);
    if (thread.joinable()) thread.join();
    if (wake[0] >= 0) ::close(wake[0]);
  }

  bool stopped() {
    const std::lock_guard lock(mutex);
    return stopping;
  }

  /// Bytes read; 0 at the end or when it is to stop.
  ssize_t read_some(std::array<char, 65536>& buffer) const {
    for (;;) {
      pollfd fds[2] = {{descriptor, POLLIN, 0}, {wake[0], POLLIN, 0}};
      if (::poll(fds, 2, -1) < 0) {
        if (errno == EINTR) continue;
        return 0;
      }
      if (fds[1].revents != 0) return 0;
      const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
      if (count >= 0 || (errno != EINTR && errno != EAGAIN)) return std::max<ssize_t>(count, 0);
    }
  }

  void speak(std::string text, double arrived) {
    if (text.empty() || stopped()) return;
    ++number;
    const std::string begin = text.substr(0, kShown);
    const bool fits = text.size() <= maker.most_bytes;
    Result<SpokenLine> made = fits ? maker.make(std::move(text)) : too_long();
    const double spoken = clock->now();
    std::unique_lock lock(mutex);
    room.wait(lock, [this] { return stopping || done.size() < kMostDone; });
    const std::string name = "line " + std::to_string(number) + ", \"" + begin + "\"";
    if (!made) {
      warnings.push_back(name + ", is left out: " + made.error().describe());
      return;
    }
    if (!made->doubt.empty()) warnings.push_back(name + ": " + made->doubt);
    made->arrived = arrived;
    made->spoken = spoken;
    done.push_back(std::move(*made));
  }
  Error too_long() const {
    return make_error(Code::out_of_range, "it has more than " + std::to_string(maker.most_bytes) +
                                              " bytes; send shorter pieces");
  }

  void run_to_the_end() {
    try {
      run();
    } catch (...) {
      const std::lock_guard lock(mutex);
      over = true;
      failure = std::current_exception();
    }
  }

  void run() {
    LineCutter cutter(maker.most_bytes, maker.cut);
    std::array<char, 65536> buffer{};
    for (;;) {
      const ssize_t count = read_some(buffer);
      const double arrived = clock->now();
      if (count == 0) break;
      for (std::string& line : cutter.push({buffer.data(), std::size_t(count)})) {
        speak(std::move(line), arrived);
      }
    }
    speak(cutter.rest(), clock->now());
    const std::lock_guard lock(mutex);
    over = true;
  }
};

VoiceLines::VoiceLines(std::unique_ptr<Impl> impl, int sample_rate)
    : impl_(std::move(impl)), sample_rate_(sample_rate) {}

VoiceLines::~VoiceLines() = default;

Result<LineMaker> voice_lines(const voice::VoiceOptions& options) {
  const Result<voice::Speech> probe = voice::speak_text("1", options);
  if (!probe) return probe.error();
  LineMaker maker;
  maker.sample_rate = probe->audio.sample_rate;
  maker.make = [options](std::string line) -> Result<SpokenLine> {
    Result<voice::Speech> speech = voice::speak_text(line, options);
    if (!speech) return speech.error();
    SpokenLine spoken;
    spoken.text = std::move(line);
    for (const std::string& warning : speech->warnings) {
      spoken.doubt += (spoken.doubt.empty() ? "" : "; ") + warning;
    }
    spoken.speech = std::move(*speech);
    return spoken;
  };
  return maker;
}

Result<std::unique_ptr<VoiceLines>> VoiceLines::open(int descriptor, LineMaker maker,
                                                     media::Clock& clock) {
  const int sample_rate = maker.sample_rate;
  auto impl = std::make_unique<Impl>();
  impl->descriptor = descriptor;
  impl->maker = std::move(maker);
  impl->clock = &clock;
  if (::pipe(impl->wake.data()) != 0) {
    return make_error(Code::io, "no pipe can be made: too many open files");
  }
  try {
    impl->thread = std::thread([raw = impl.get()] { raw->run_to_the_end(); });
  } catch (const std::system_error&) {
    return make_error(Code::io, "no thread can be started for the lines");
  }
  return std::unique_ptr<VoiceLines>(new VoiceLines(std::move(impl), sample_rate));
}

std::vector<SpokenLine> VoiceLines::take() {
  const std::lock_guard lock(impl_->mutex);
  impl_->room.notify_all();
  return std::exchange(impl_->done, {});
}

bool VoiceLines::ended() {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->failure) std::rethrow_exception(impl_->failure);
  return impl_->over && impl_->done.empty();
}

std::vector<std::string> VoiceLines::take_warnings() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->warnings, {});
}

}  // namespace animeme::speech
