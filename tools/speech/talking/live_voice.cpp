#include "tools/speech/talking/live_voice.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "dam/maths/raised_cosine.h"
#include "dam/signal/fap_signal.h"
#include "tools/speech/talking/face_coding_internal.h"
#include "tools/speech/talking/line_news_internal.h"
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
constexpr double kGrain = 0.015;        // of the delay: frames are looked for every 10 ms
constexpr double kEndRest = 0.4;        // seconds after the last sound, to close the mouth
constexpr double kVoiceFade = 0.02;     // seconds, of sound that breaks off
constexpr double kMouthCloses = 0.12;   // seconds, where a command ends the voice
constexpr double kMouthReturns = 0.08;  // seconds in which the next sound may open it
constexpr double kReaches = 0.3;        // seconds that sound bears on the mouth behind its end
constexpr std::size_t kComing = 3;      // frames in which new sound begins
constexpr double kHeld = 0.3;           // seconds of silence inside of speech
constexpr double kQuiet = 0.004;        // of full scale: below it nothing is said
constexpr double kShutGap = 30;         // FAP units: lips that are nearly closed

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

  /// Sound of the voice that has a place.
  struct Placed {
    std::int64_t start = 0;
    std::vector<float> samples;
  };
  std::deque<Placed> placed = {};       // and may not have been passed on, for a pause
  bool paused = false;                  // nothing is taken
  std::vector<float> back = {};         // what a pause has taken back; comes before what waits
  std::optional<std::int64_t> held_at;  // sample where it began; then events wait, too

  TalkingFace life;         // what moves besides the mouth
  fap::Frame rest;          // a mouth that says nothing
  fap::Frame mouth = rest;  // as shown last
  LineEvents events = {};
  std::int64_t heard = 0;  // samples of the voice that have a place
  struct Mark {
    std::string id;
    std::int64_t at = 0;  // samples of the voice before it
  };
  std::deque<Mark> marks = {};
  std::deque<double> loudness = {};  // sums of squares of frames, from `first_loud` on
  std::int64_t first_loud = 0;
  double spoke = -1;                        // seconds: when the voice was last heard
  double closed_from = -1, closed_to = -1;  // seconds in which a command has closed the mouth
  bool closed = false;                      // likewise
  fap::Frame closing = rest;                // from which it began to

  double frame_due() const { return double(number * frame_ticks) / info.timescale; }
  double sound_due() const {
    if (!sound) return std::numeric_limits<double>::infinity();
    return double(sound->next_time()) / info.audio->sample_rate - options.audio_ahead;
  }
  // Sample before which all sound is on its way to be heard.
  std::int64_t passed() const { return sound ? sound->made() : std::llround(frame_due() * rate); }
  std::vector<float> take(std::size_t most);
  std::size_t waiting() const { return held.size() + back.size() + pipe->waiting(); }
  Result<void> fill(double now);
  Result<void> wait_for_more();
  Result<void> lay(std::vector<float> samples, bool voice = true, bool begins = false);
  void listen(std::int64_t start, const std::vector<float>& samples);
  void collect(double now);
  void follow(const LineNews& news, double time);
  void discard(bool now);
  void pause();
  void fall_silent();
  void reach_marks(bool all);
  fap::Frame shown(fap::Frame frame);
  dam::MoodMouth::Shares sounds(const fap::Frame& frame);
  Result<LiveUnit> make_plane();
};

// Gives the next samples their place in time. `voice`: else it is silence between. `begins`: they
// are faded in.
Result<void> LiveVoice::Impl::lay(std::vector<float> samples, bool voice, bool begins) {
  if (samples.empty()) return {};
  const std::int64_t start = mixed;
  mixed += std::int64_t(samples.size());
  if (voice) {
    if (held_at) events.go_on(double(start - *std::exchange(held_at, std::nullopt)) / rate);
    heard += std::int64_t(samples.size());
    reach_marks(false);
    const auto gone = [this](const Placed& one) {
      return one.start + std::int64_t(one.samples.size()) <= passed();
    };
    while (!placed.empty() && gone(placed.front())) placed.pop_front();
    if (options.commands != nullptr) placed.push_back({start, samples});
  }
  const double fade = begins ? kVoiceFade * rate : 0;
  for (std::size_t i = 0; i < samples.size() && double(i) < fade; ++i) {
    samples[i] *= float(dam::raised_step((double(i) + 1) / (fade + 1)));
  }
  face->push(samples);
  listen(start, samples);
  if (sound) sound->add(start, std::move(samples));
  const Result<dam::Signal> made = face->pull();
  if (!made) return made.error();
  if (made->frames() == 0) return {};
  Result<fap::Sequence> clip = dam::to_sequence(*made);
  if (!clip) return clip.error();
  frames.insert(frames.end(), clip->frames.begin(), clip->frames.end());
  return {};
}

// The next samples of the voice, as far as they are there.
std::vector<float> LiveVoice::Impl::take(std::size_t most) {
  const auto first = std::ptrdiff_t(std::min(most, back.size()));
  std::vector<float> some(back.begin(), back.begin() + first);
  back.erase(back.begin(), back.begin() + first);
  const std::vector<float> more = pipe->take(most - some.size());
  some.insert(some.end(), more.begin(), more.end());
  return some;
}

Result<void> LiveVoice::Impl::fill(double now) {
  const auto until = [&](double seconds) {
    return std::size_t(std::max<std::int64_t>(std::llround(seconds * rate) - mixed, 0));
  };
  if (!paused) {
    auto ok = starved ? wait_for_more() : lay(take(until(now + options.delay)));
    if (!ok) return ok;
  }
  if (!end && held.empty() && back.empty() && pipe->over()) {
    end = std::max(double(mixed) / rate, now) + kEndRest;
    reach_marks(true);
  }
  // What has not come by now is silence.
  const std::size_t missing = until(now + options.delay - kJitter);
  if (missing == 0) return {};
  if (!starved && sound) sound->end_at(mixed, std::llround(kVoiceFade * rate));
  starved = true;
  return lay(std::vector<float>(missing, 0.0f), false);
}

// A voice that has broken off goes on when there is as much of it as it may come late: else the
// next piece would be late, too, and the next one.
Result<void> LiveVoice::Impl::wait_for_more() {
  const auto enough = std::size_t(std::llround(kJitter * rate));
  const std::vector<float> more = take(enough - held.size());
  held.insert(held.end(), more.begin(), more.end());
  if (held.empty() || (held.size() < enough && !pipe->over())) return {};
  starved = false;
  return lay(std::exchange(held, {}), true, true);
}

// How loud each frame is.
void LiveVoice::Impl::listen(std::int64_t start, const std::vector<float>& samples) {
  const double a_frame = double(frame_ticks) / info.timescale * rate;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto frame = std::int64_t(double(start + std::int64_t(i)) / a_frame) - first_loud;
    if (frame < 0) continue;
    if (loudness.size() <= std::size_t(frame)) loudness.resize(std::size_t(frame) + 1, 0.0);
    loudness[std::size_t(frame)] += double(samples[i]) * double(samples[i]) / a_frame;
  }
}

void LiveVoice::Impl::collect(double now) {
  if (options.commands == nullptr) return;
  const double time = std::min(now, frame_due());
  while (auto line = options.commands->take(false)) {
    if (!line->mark) continue;  // there are no other lines
    marks.push_back({line->id, heard + std::int64_t(waiting())});
  }
  for (const LineNews& news : options.commands->take_news()) follow(news, time);
  reach_marks(false);
  // "end": what has come is presented.
  if (options.commands->ended() && !end) {
    end = double(mixed + std::int64_t(waiting())) / rate + kEndRest;
  }
}

// Marks behind sound that has a place, or all of them where the sound has ended.
void LiveVoice::Impl::reach_marks(bool all) {
  while (!marks.empty() && (all || marks.front().at <= heard)) {
    LineEvent mark{.what = LineEvent::What::mark, .time = double(mixed) / rate, .id = {}};
    mark.time = std::max(mark.time, frame_due());
    mark.text = marks.front().id;
    events.add(std::move(mark));
    marks.pop_front();
  }
}

void LiveVoice::Impl::follow(const LineNews& news, double time) {
  if (news.what == LineNews::What::word || direct_face(life, news)) return;
  events.add(event_of(news, time));
  if (news.what == LineNews::What::paused) return pause();
  if (news.what == LineNews::What::resumed) paused = false;
  const bool stopped = news.what == LineNews::What::stopped;
  if (!stopped && news.what != LineNews::What::dropped) return;
  if (stopped) events.cut(time, news.line, "stopped");
  discard(stopped);
  const std::int64_t left = heard + std::int64_t(back.size());
  std::erase_if(marks, [&](const Mark& mark) {
    if (mark.at <= left) return false;
    LineEvent cancelled{.what = LineEvent::What::cancelled, .time = time, .id = mark.id};
    cancelled.why = stopped ? "stopped" : "dropped";
    events.add(std::move(cancelled));
    return true;
  });
}

// Nothing that was sent before is heard. `now`: neither is what has a place already.
void LiveVoice::Impl::discard(bool now) {
  pipe->discard();
  held.clear();
  if (!now) {
    if (!starved && back.empty() && sound) sound->end_at(mixed, std::llround(kVoiceFade * rate));
    starved = true;
    return;
  }
  paused = false;
  back.clear();
  held_at.reset();
  fall_silent();
}

// What is not on its way to be heard yet waits, in front of what comes later.
void LiveVoice::Impl::pause() {
  paused = true;
  const std::int64_t from = passed();
  std::vector<float> left;
  std::int64_t begin = 0;
  for (const Placed& one : placed) {
    const auto gone = std::ptrdiff_t(std::max<std::int64_t>(from - one.start, 0));
    if (gone >= std::ptrdiff_t(one.samples.size())) continue;
    if (left.empty()) begin = one.start + gone;
    left.insert(left.end(), one.samples.begin() + gone, one.samples.end());
  }
  if (left.empty() && held.empty()) return;
  heard -= std::int64_t(left.size());
  if (!left.empty()) {
    events.hold(double(begin) / rate);
    held_at = begin;
  }
  left.insert(left.end(), held.begin(), held.end());
  back.insert(back.begin(), left.begin(), left.end());
  held.clear();
  end.reset();
  fall_silent();
}

void LiveVoice::Impl::fall_silent() {
  const auto fade = std::llround(kVoiceFade * rate);
  starved = true;
  placed.clear();
  if (sound) sound->end_at(sound->made() + fade, fade);
  if (frame_due() >= closed_to) {
    closed_from = frame_due();
    closing = mouth;
  }
  closed_to = std::max(double(mixed) / rate, closed_from + kMouthCloses);
  closed = true;
  for (double& one : loudness) one = 0;
}

// A mouth that a command has closed.
fap::Frame LiveVoice::Impl::shown(fap::Frame frame) {
  const double time = frame_due(), step = double(frame_ticks) / info.timescale;
  // The old sound bears on the mouth a little longer; new sound opens it.
  if (closed && time >= closed_to) {
    double loudest = 0;
    for (std::size_t i = 0; i < std::min(kComing, loudness.size()); ++i) {
      loudest = std::max(loudest, std::sqrt(loudness[i]));
    }
    closed = loudest <= kQuiet && time < closed_to + kReaches;
    if (!closed) closed_to = time;
  }
  if (closed || (closed_from >= 0 && time < closed_to + kMouthReturns)) {
    const double left = std::max(0.0, 1 - (time - closed_from + step) / kMouthCloses);
    const double opens =
        closed ? 0 : std::clamp((time - closed_to + step) / kMouthReturns, 0.0, 1.0);
    for (std::size_t f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
      if (!frame.mask[f]) continue;
      const double still = rest.value[f];
      frame.value[f] = int(std::lround(still + left * (closing.value[f] - still) +
                                       opens * (frame.value[f] - still)));
    }
  }
  mouth = frame;
  return frame;
}

// What moods leave to the mouth, as far as it can be seen.
dam::MoodMouth::Shares LiveVoice::Impl::sounds(const fap::Frame& frame) {
  const double level = loudness.empty() ? 0 : std::sqrt(loudness.front());
  if (!loudness.empty()) loudness.pop_front();
  first_loud = number + 1;
  if (level > kQuiet) spoke = frame_due();
  dam::MoodMouth::Shares shares;
  if (spoke < 0 || frame_due() - spoke > kHeld) return shares;
  shares.speech = 1;
  const double gap = -double(frame.value[4] + frame.value[5]);  // lower and upper inner lip
  if (level > kQuiet) shares.shut = std::clamp(1 - gap / kShutGap, 0.0, 1.0);
  return shares;
}

Result<LiveUnit> LiveVoice::Impl::make_plane() {
  LiveUnit unit;
  unit.track = LiveTrack::face;
  unit.time = number * frame_ticks;
  unit.duration = frame_ticks;
  if (frames.empty()) return make_error(Code::io, "the face was not ready in time");
  fap::Frame frame = shown(std::move(frames.front()));
  frames.pop_front();
  frame = life.accompany(frame, sounds(frame));
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
  const Result<fap::Frame> rest = resting->next();
  if (!rest) return rest.error();
  still.idle_motion = options.idle_motion;
  still.idle = options.idle;
  still.mood = options.mood;
  still.over = options.over;
  still.keep = options.keep;
  // Without quantisation, angles end at one degree.
  if (options.fap_quant == 0) still.idle.still.gaze = still.idle.still.head = true;
  Result<TalkingFace> life = TalkingFace::open(model, still);
  if (!life) return life.error();
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
      coding_of_face(model, *life, options.synthesis.rate, options.fap_quant, options.intra_seconds,
                     options.coding_delay);
  Result<FaceShape> shape = shape_of_face(coding, *life);
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
                                          .frame_ticks = shape->frame_ticks,
                                          .life = std::move(*life),
                                          .rest = *rest});
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
  impl_->collect(now);
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

void LiveVoice::sent(const LiveUnit& unit, double instant) {
  (void)instant;
  if (unit.track != LiveTrack::face) return;
  impl_->events.tell(media::seconds_of(impl_->info, unit.track, unit.time));
}

void LiveVoice::expect_loss(int percent) {
  if (impl_->sound) impl_->sound->expect_loss(percent);
}

std::vector<LineEvent> LiveVoice::take_events() { return impl_->events.take(); }

void LiveVoice::end(const std::string& why) {
  if (impl_->options.commands == nullptr) return;
  const double time = impl_->frame_due();
  impl_->options.commands->abandon(why);
  impl_->collect(time);
  for (const Impl::Mark& mark : impl_->marks) {
    // Sound that has ended before its mark is reached brings it about.
    LineEvent event{.what = LineEvent::What::cancelled, .time = time, .id = mark.id};
    event.why = why;
    impl_->events.add(std::move(event));
  }
  impl_->marks.clear();
  if (impl_->held_at) impl_->events.cut(time, std::numeric_limits<std::uint64_t>::max(), why);
  impl_->events.tell(std::numeric_limits<double>::infinity());
}

std::vector<std::string> LiveVoice::take_warnings() {
  std::vector<std::string> warnings;
  if (const auto error = impl_->pipe->take_error()) warnings.push_back(error->message);
  return warnings;
}

}  // namespace animeme::speech
