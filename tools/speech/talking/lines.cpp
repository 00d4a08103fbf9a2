#include "tools/speech/talking/lines.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "tools/speech/talking/control_socket.h"
#include "tools/speech/talking/line_cutter_internal.h"
#include "tools/speech/talking/line_queue.h"
#include "tools/speech/talking/written_text.h"

namespace animeme::speech {

namespace {

constexpr int kFullMs = 50;  // then a full queue is looked at again

// The voice keeps its variant ("+f3") in another language, unless that names one.
std::string language_of_line(const std::string& usual, const std::string& wanted) {
  if (wanted.empty()) return usual;
  const std::size_t variant = usual.find('+');
  if (variant == std::string::npos || wanted.find('+') != std::string::npos) return wanted;
  return wanted + usual.substr(variant);
}

}  // namespace

struct VoiceLines::Impl {
  int descriptor = -1;
  ControlSocket* control = nullptr;
  std::array<int, 2> wake = {-1, -1};  // a pipe: closing its end stops the reader
  LineMaker maker;
  media::Clock* clock = nullptr;
  LineQueue queue;

  std::mutex mutex;
  std::exception_ptr failure;  // no memory, most likely; goes to who asks whether it is over

  std::thread reader, voice;  // last: they use all of the above

  Impl(LineMaker making, media::Clock& time)
      : maker(std::move(making)),
        clock(&time),
        queue(maker.most_bytes, maker.cut, maker.json, maker.pieces, maker.one_line) {}
  ~Impl() {
    queue.leave();
    if (wake[1] >= 0) ::close(wake[1]);
    for (std::thread* thread : {&reader, &voice}) {
      if (thread->joinable()) thread->join();
    }
    if (wake[0] >= 0) ::close(wake[0]);
  }

  template <class Work>
  void guarded(Work work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  }

  void speak() {
    while (auto job = queue.next_job()) {
      const std::uint64_t line = job->line;
      const Wanted wanted = [this, line] { return queue.wanted(line); };
      Result<SpokenLine> speech = make_line(maker, std::move(*job), wanted);
      queue.made(line, std::move(speech), clock->now());
    }
  }

  void read() {
    LineCutter cutter(maker.most_bytes, maker.cut);
    bool open = descriptor >= 0;
    std::vector<pollfd> wanted;
    while (open || control != nullptr) {
      const bool full = open && queue.full();
      wanted = {{wake[0], POLLIN, 0}};
      if (control != nullptr) control->add_to(wanted);
      if (open && !full) wanted.push_back({descriptor, POLLIN, 0});
      if (::poll(wanted.data(), wanted.size(), full ? kFullMs : -1) < 0) {
        if (errno == EINTR) continue;
        return;
      }
      if (wanted[0].revents != 0) return;
      const double now = clock->now();
      if (open && !full && wanted.back().revents != 0) open = read_some(cutter, now);
      if (control == nullptr) continue;
      control->read(wanted, [&](std::string line) { return queue.push(std::move(line), now); });
    }
  }

  /// False at the end.
  bool read_some(LineCutter& cutter, double now) {
    std::array<char, 65536> buffer;
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return true;
    if (count > 0) {
      for (std::string& line : cutter.push({buffer.data(), std::size_t(count)})) {
        (void)queue.push(std::move(line), now);
      }
      return true;
    }
    (void)queue.push(cutter.rest(), now);
    queue.close(now);
    return false;
  }
};

VoiceLines::VoiceLines(std::unique_ptr<Impl> impl, int sample_rate)
    : impl_(std::move(impl)), sample_rate_(sample_rate) {}

VoiceLines::~VoiceLines() = default;

Result<LineMaker> voice_lines(const voice::VoiceOptions& options, bool speak_marks) {
  const Result<voice::Speech> probe = voice::speak_text("1", options);
  if (!probe) return probe.error();
  LineMaker maker;
  maker.sample_rate = probe->audio.sample_rate;
  maker.make_in = [options, speak_marks](std::string line, const std::string& language,
                                         const Wanted&) -> Result<SpokenLine> {
    voice::VoiceOptions how = options;
    how.language = language_of_line(options.language, language);
    SpokenLine spoken;
    const auto doubt = [&spoken](const std::string& warning) {
      spoken.doubt += (spoken.doubt.empty() ? "" : "; ") + warning;
    };
    tools::Log log;
    log.warn = doubt;
    Result<voice::Speech> speech = voice::speak_text(line_to_say(line, speak_marks, log), how);
    if (!speech) return speech.error();
    spoken.text = std::move(line);
    for (const std::string& warning : speech->warnings) doubt(warning);
    spoken.speech = std::move(*speech);
    return spoken;
  };
  maker.make = [make = maker.make_in](std::string line, const Wanted& wanted) {
    return make(std::move(line), {}, wanted);
  };
  return maker;
}

Result<std::unique_ptr<VoiceLines>> VoiceLines::open(int descriptor, LineMaker maker,
                                                     media::Clock& clock, ControlSocket* control) {
  const int sample_rate = maker.sample_rate;
  auto impl = std::make_unique<Impl>(std::move(maker), clock);
  impl->descriptor = descriptor;
  impl->control = control;
  if (::pipe(impl->wake.data()) != 0) {
    return make_error(Code::io, "no pipe can be made: too many open files");
  }
  try {
    impl->reader = std::thread([raw = impl.get()] { raw->guarded([raw] { raw->read(); }); });
    impl->voice = std::thread([raw = impl.get()] { raw->guarded([raw] { raw->speak(); }); });
  } catch (const std::system_error&) {
    return make_error(Code::io, "no thread can be started for the lines");
  }
  return std::unique_ptr<VoiceLines>(new VoiceLines(std::move(impl), sample_rate));
}

std::optional<SpokenLine> VoiceLines::take(bool only_joining) {
  return impl_->queue.take(only_joining);
}

std::optional<double> VoiceLines::improvable_since() { return impl_->queue.improvable_since(); }

std::vector<LineNews> VoiceLines::take_news() { return impl_->queue.take_news(); }

bool VoiceLines::ended() {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->failure) std::rethrow_exception(impl_->failure);
  return impl_->queue.ended();
}

void VoiceLines::abandon(const std::string& why) { impl_->queue.abandon(why); }

std::vector<std::string> VoiceLines::take_warnings() { return impl_->queue.take_warnings(); }

}  // namespace animeme::speech
