#include "tools/speech/live_voice.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "dam/signal/fap_signal.h"
#include "tools/speech/face_coding_internal.h"
#include "tools/speech/heard_face.h"
#include "tools/speech/live_sound.h"

namespace animeme::speech {

namespace {

using media::LiveTrack;
using media::LiveUnit;

constexpr double kLeastLiveDelay = 0.25, kMostLiveDelay = 2;
// Of the delay: sound may come so much later than the sound before. What comes later still moves
// the sound back, up to the whole of the delay.
constexpr double kJitter = 0.06;
constexpr double kGrain = 0.015;    // of the delay: frames are looked for every 10 ms
constexpr double kKeptAhead = 0.5;  // seconds of sound that are read before they are wanted
constexpr double kEndRest = 0.4;    // seconds after the last sound, to close the mouth
constexpr int kWaitMs = 50;         // for sound; then a wish to stop is looked for

// Samples from a descriptor, read in a thread, so that the clock never waits for them.
class SoundPipe {
 public:
  SoundPipe(int descriptor, std::optional<BareSound> bare) : descriptor_(descriptor), bytes_(bare) {
    thread_ = std::thread([this] { read(); });
  }
  ~SoundPipe() {
    stop_ = true;
    room_.notify_all();
    thread_.join();
  }
  // The rate, once it is known or there will be none (0).
  Result<int> wait_for_rate() {
    std::unique_lock lock(mutex_);
    came_.wait(lock, [this] { return rate_ > 0 || ended_; });
    if (error_) return *error_;
    return rate_;
  }
  // At most `most` samples; none if none are there.
  std::vector<float> take(std::size_t most) {
    const std::lock_guard lock(mutex_);
    const std::size_t count = std::min(most, samples_.size());
    std::vector<float> some(samples_.begin(), samples_.begin() + std::ptrdiff_t(count));
    samples_.erase(samples_.begin(), samples_.begin() + std::ptrdiff_t(count));
    if (count > 0) room_.notify_all();
    return some;
  }
  // Nothing more will come.
  bool over() {
    const std::lock_guard lock(mutex_);
    return ended_ && samples_.empty();
  }
  std::optional<Error> take_error() {
    const std::lock_guard lock(mutex_);
    return std::exchange(error_, std::nullopt);
  }

 private:
  bool full() const { return rate_ > 0 && double(samples_.size()) > kKeptAhead * rate_; }

  void read() {
    std::array<std::uint8_t, 4096> block;
    std::vector<float> samples;
    while (!stop_) {
      {
        std::unique_lock lock(mutex_);
        room_.wait(lock, [this] { return stop_ || !full(); });
      }
      pollfd wanted{descriptor_, POLLIN, 0};
      const int ready = ::poll(&wanted, 1, kWaitMs);
      if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
      const ssize_t got = ready < 0 ? -1 : ::read(descriptor_, block.data(), block.size());
      if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      samples.clear();
      Result<void> good;
      if (got > 0) good = bytes_.push(std::span(block).first(std::size_t(got)), samples);
      const std::lock_guard lock(mutex_);
      rate_ = bytes_.sample_rate();
      samples_.insert(samples_.end(), samples.begin(), samples.end());
      if (got < 0) error_ = make_error(Code::io, "the sound cannot be read any more");
      if (!good) error_ = good.error();
      ended_ = got <= 0 || !good;
      came_.notify_all();
      if (ended_) return;
    }
  }

  int descriptor_;
  SoundBytes bytes_;
  std::mutex mutex_;
  std::condition_variable came_, room_;
  std::deque<float> samples_;
  std::optional<Error> error_;
  int rate_ = 0;
  bool ended_ = false;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace

struct LiveVoice::Impl {
  LiveVoiceOptions options;
  std::unique_ptr<SoundPipe> pipe;
  int rate;
  std::unique_ptr<HeardFace> face;
  std::optional<LiveSound> sound;
  fba::LiveEncoder encoder;
  media::LiveInfo info;
  std::int64_t frame_ticks;

  std::deque<fap::Frame> frames;  // that are made
  std::int64_t number = 0;        // of the next plane
  std::int64_t mixed = 0;         // samples that have a place, silence included
  std::optional<double> end;      // seconds

  double frame_due() const { return double(number * frame_ticks) / info.timescale; }
  double sound_due() const {
    if (!sound) return std::numeric_limits<double>::infinity();
    return double(sound->next_time()) / info.audio->sample_rate - options.audio_ahead;
  }
  Result<void> fill(double now);
  Result<void> lay(std::vector<float> samples);
  Result<LiveUnit> make_plane();
};

// Gives the next samples their place in time.
Result<void> LiveVoice::Impl::lay(std::vector<float> samples) {
  if (samples.empty()) return {};
  face->push(samples);
  const std::int64_t start = mixed;
  mixed += std::int64_t(samples.size());
  if (sound) sound->add(start, std::move(samples));
  const Result<dam::Signal> made = face->pull();
  if (!made) return made.error();
  if (made->frames() == 0) return {};
  Result<fap::Sequence> clip = dam::to_sequence(*made);
  if (!clip) return clip.error();
  frames.insert(frames.end(), clip->frames.begin(), clip->frames.end());
  return {};
}

Result<void> LiveVoice::Impl::fill(double now) {
  const auto until = [&](double seconds) {
    return std::max<std::int64_t>(std::llround(seconds * rate) - mixed, 0);
  };
  if (auto ok = lay(pipe->take(std::size_t(until(now + options.delay)))); !ok) return ok;
  if (!end && pipe->over()) end = std::max(double(mixed) / rate, now) + kEndRest;
  // What has not come by now is silence.
  return lay(std::vector<float>(std::size_t(until(now + options.delay - kJitter)), 0.0f));
}

Result<LiveUnit> LiveVoice::Impl::make_plane() {
  LiveUnit unit;
  unit.track = LiveTrack::face;
  unit.time = number * frame_ticks;
  unit.duration = frame_ticks;
  if (frames.empty()) return make_error(Code::io, "the face was not ready in time");
  fap::Frame frame = std::move(frames.front());
  frames.pop_front();
  frame.number = number++;
  Result<std::vector<std::uint8_t>> bytes = encoder.write(frame);
  if (!bytes) return bytes.error();
  unit.bytes = std::move(*bytes);
  unit.intra = encoder.intra();
  return unit;
}

LiveVoice::LiveVoice(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LiveVoice::~LiveVoice() = default;

Result<std::unique_ptr<LiveVoice>> LiveVoice::open(const dam::Model& model, int descriptor,
                                                   const LiveVoiceOptions& options) {
  if (!(options.delay >= kLeastLiveDelay && options.delay <= kMostLiveDelay)) {
    return make_error(Code::invalid_argument, "the delay must lie between 0.25 and 2 s");
  }
  Result<TalkingFace> resting = TalkingFace::open(model, {options.synthesis, false, 1});
  if (!resting) return resting.error();
  auto pipe = std::make_unique<SoundPipe>(descriptor, options.bare);
  const Result<int> rate = pipe->wait_for_rate();
  if (!rate) return rate.error();
  if (*rate == 0) return make_error(Code::truncated, "it ended before there was any sound");
  HeardFaceOptions following{options.synthesis, options.language, options.delay - kJitter - kGrain};
  auto face = HeardFace::open(model, *rate, following);
  if (!face) return face.error();
  std::optional<LiveSound> sound;
  if (options.audio) {
    Result<LiveSound> opened = LiveSound::open(*rate, *options.audio);
    if (!opened) return opened.error();
    sound = std::move(*opened);
  }
  const fba::LiveOptions coding = coding_of_face(model, *resting, options.synthesis.rate,
                                                 options.fap_quant, options.intra_seconds);
  Result<FaceShape> shape = shape_of_face(coding, *resting);
  if (!shape) return shape.error();
  media::LiveInfo info = std::move(shape->info);
  if (sound) info.audio = sound->format();
  auto impl = std::make_unique<Impl>(Impl{options,
                                          std::move(pipe),
                                          *rate,
                                          std::move(*face),
                                          std::move(sound),
                                          fba::LiveEncoder(coding),
                                          std::move(info),
                                          shape->frame_ticks,
                                          {},
                                          0,
                                          0,
                                          {}});
  return std::unique_ptr<LiveVoice>(new LiveVoice(std::move(impl)));
}

const media::LiveInfo& LiveVoice::info() const { return impl_->info; }
double LiveVoice::audio_ahead() const { return impl_->options.audio_ahead; }

std::optional<double> LiveVoice::next_due() {
  const double due = std::min(impl_->frame_due(), impl_->sound_due());
  if (due >= impl_->options.duration || (impl_->end && due >= *impl_->end)) return std::nullopt;
  return due;
}

Result<std::vector<LiveUnit>> LiveVoice::take(double now) {
  std::vector<LiveUnit> units;
  if (auto ok = impl_->fill(now); !ok) return ok.error();
  for (;;) {
    const bool sound_first = impl_->sound_due() <= impl_->frame_due();
    if (std::min(impl_->sound_due(), impl_->frame_due()) > now) return units;
    if (sound_first) {
      Result<media::AudioPacket> packet = impl_->sound->next();
      if (!packet) return packet.error();
      units.push_back(
          {LiveTrack::audio, std::move(packet->bytes), false, packet->time, packet->duration});
    } else {
      Result<LiveUnit> unit = impl_->make_plane();
      if (!unit) return unit.error();
      units.push_back(std::move(*unit));
    }
  }
}

std::vector<std::string> LiveVoice::take_warnings() {
  const auto error = impl_->pipe->take_error();
  if (!error) return {};
  return {error->message};
}

}  // namespace animeme::speech
