#include "tools/speech/talking/live_voice.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "dam/maths/raised_cosine.h"
#include "dam/signal/fap_signal.h"
#include "tools/speech/talking/face_coding_internal.h"
#include "tools/speech/talking/live_sound.h"
#include "tools/speech/talking/voice_driven_face.h"

namespace animeme::speech {

namespace {

using media::LiveTrack;
using media::LiveUnit;

constexpr double kLeastLiveDelay = 0.25, kMostLiveDelay = 2;
// Of the delay: sound may come so much later than the sound before. What comes later still moves
// the sound back, up to the whole of the delay.
constexpr double kJitter = 0.06;
constexpr double kGrain = 0.015;     // of the delay: frames are looked for every 10 ms
constexpr double kEndRest = 0.4;     // seconds after the last sound, to close the mouth
constexpr double kVoiceFade = 0.02;  // seconds, of sound that breaks off

Result<void> check(const LiveVoiceOptions& options) {
  if (options.delay >= kLeastLiveDelay && options.delay <= kMostLiveDelay) return {};
  return make_error(Code::invalid_argument, "the delay must be between 0.25 and 2 s");
}

}  // namespace

struct LiveVoice::Impl {
  LiveVoiceOptions options;
  std::unique_ptr<SoundFeed> pipe;
  int rate;
  std::unique_ptr<VoiceDrivenFace> face;
  std::optional<LiveSound> sound;
  fba::LiveEncoder encoder;
  media::LiveInfo info;
  std::int64_t frame_ticks;
  WaitingSound waiting_sound = {};

  std::deque<fap::Frame> frames;  // that are made
  std::int64_t number = 0;        // of the next plane
  std::int64_t mixed = 0;         // samples that have a place, silence included
  std::optional<double> end;      // seconds
  bool starved = false;           // nothing came in time
  std::vector<float> held;        // what has come since, until it is enough to go on with

  double frame_due() const { return double(number * frame_ticks) / info.timescale; }
  double sound_due() const {
    if (!sound) return std::numeric_limits<double>::infinity();
    return double(sound->next_time()) / info.audio->sample_rate - options.audio_ahead;
  }
  Result<void> fill(double now);
  Result<void> wait_for_more();
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
    return std::size_t(std::max<std::int64_t>(std::llround(seconds * rate) - mixed, 0));
  };
  if (starved) {
    if (auto ok = wait_for_more(); !ok) return ok;
  } else {
    if (auto ok = lay(pipe->take(until(now + options.delay))); !ok) return ok;
  }
  if (!end && held.empty() && pipe->over()) end = std::max(double(mixed) / rate, now) + kEndRest;
  // What has not come by now is silence.
  const std::size_t missing = until(now + options.delay - kJitter);
  if (missing == 0) return {};
  if (!starved && sound) sound->end_at(mixed, std::llround(kVoiceFade * rate));
  starved = true;
  return lay(std::vector<float>(missing, 0.0f));
}

// A voice that has broken off goes on when there is as much of it as it may come late: else the
// next piece would be late, too, and the next one.
Result<void> LiveVoice::Impl::wait_for_more() {
  const auto enough = std::size_t(std::llround(kJitter * rate));
  const std::vector<float> more = pipe->take(enough - held.size());
  held.insert(held.end(), more.begin(), more.end());
  if (held.empty() || (held.size() < enough && !pipe->over())) return {};
  const double fade = kVoiceFade * rate;
  for (std::size_t i = 0; i < held.size() && double(i) < fade; ++i) {
    held[i] *= float(dam::raised_step((double(i) + 1) / (fade + 1)));
  }
  starved = false;
  return lay(std::exchange(held, {}));
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
  unit.time -= std::int64_t(encoder.held()) * frame_ticks;
  unit.bytes = std::move(*bytes);
  unit.intra = encoder.intra();
  return unit;
}

LiveVoice::LiveVoice(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LiveVoice::~LiveVoice() = default;

Result<std::unique_ptr<LiveVoice>> LiveVoice::open(const dam::Model& model, int descriptor,
                                                   const LiveVoiceOptions& options) {
  if (auto ok = check(options); !ok) return ok.error();
  auto pipe = std::make_unique<SoundPipe>(descriptor, options.bare);
  const Result<int> rate = pipe->wait_for_rate();
  if (!rate) return rate.error();
  if (*rate == 0) return make_error(Code::truncated, "it ended before there was any sound");
  return open(model, std::move(pipe), *rate, options);
}

Result<std::unique_ptr<LiveVoice>> LiveVoice::open(const dam::Model& model,
                                                   std::unique_ptr<SoundFeed> pipe, int rate,
                                                   const LiveVoiceOptions& options) {
  if (auto ok = check(options); !ok) return ok.error();
  FaceOptions still;  // what VoiceDrivenFace moves, and nothing else
  still.synthesis = options.synthesis;
  still.synthesis.tongue = false;
  Result<TalkingFace> resting = TalkingFace::open(model, still);
  if (!resting) return resting.error();
  VoiceDrivenFaceOptions following{options.synthesis, options.language,
                                   options.delay - kJitter - kGrain};
  auto face = VoiceDrivenFace::open(model, rate, following);
  if (!face) return face.error();
  std::optional<LiveSound> sound;
  if (options.audio) {
    Result<LiveSound> opened = LiveSound::open(rate, *options.audio);
    if (!opened) return opened.error();
    sound = std::move(*opened);
  }
  const fba::LiveOptions coding =
      coding_of_face(model, *resting, options.synthesis.rate, options.fap_quant,
                     options.intra_seconds, options.coding_delay);
  Result<FaceShape> shape = shape_of_face(coding, *resting);
  if (!shape) return shape.error();
  media::LiveInfo info = std::move(shape->info);
  if (sound) info.audio = sound->format();
  auto impl = std::make_unique<Impl>(Impl{.options = options,
                                          .pipe = std::move(pipe),
                                          .rate = rate,
                                          .face = std::move(*face),
                                          .sound = std::move(sound),
                                          .encoder = fba::LiveEncoder(coding),
                                          .info = std::move(info),
                                          .frame_ticks = shape->frame_ticks});
  return std::unique_ptr<LiveVoice>(new LiveVoice(std::move(impl)));
}

const media::LiveInfo& LiveVoice::info() const { return impl_->info; }
double LiveVoice::audio_ahead() const { return impl_->options.audio_ahead; }
double LiveVoice::delay() const { return impl_->options.coding_delay; }

std::optional<double> LiveVoice::next_due() {
  const double due =
      std::min({impl_->frame_due(), impl_->sound_due(), impl_->waiting_sound.next_due()});
  const double end =
      std::min(impl_->options.duration, impl_->end.value_or(impl_->options.duration));
  if (due >= end + impl_->options.coding_delay) return std::nullopt;
  return due;
}

Result<std::vector<LiveUnit>> LiveVoice::take(double now) {
  std::vector<LiveUnit> units;
  if (auto ok = impl_->fill(now); !ok) return ok.error();
  for (;;) {
    const bool sound_first = impl_->sound_due() <= impl_->frame_due();
    const double due = std::min(impl_->sound_due(), impl_->frame_due());
    impl_->waiting_sound.release(std::min(due, now), units);
    if (due > now) return units;
    if (sound_first) {
      Result<media::AudioPacket> packet = impl_->sound->next();
      if (!packet) return packet.error();
      LiveUnit unit{LiveTrack::audio, std::move(packet->bytes), false, packet->time,
                    packet->duration};
      if (impl_->options.coding_delay > 0) {
        impl_->waiting_sound.add(std::move(unit), due + impl_->options.coding_delay);
      } else {
        units.push_back(std::move(unit));
      }
    } else {
      Result<LiveUnit> unit = impl_->make_plane();
      if (!unit) return unit.error();
      if (!unit->bytes.empty()) units.push_back(std::move(*unit));
    }
  }
}

std::vector<std::string> LiveVoice::take_warnings() {
  const auto error = impl_->pipe->take_error();
  if (!error) return {};
  return {error->message};
}

}  // namespace animeme::speech
