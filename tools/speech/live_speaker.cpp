#include "tools/speech/live_speaker.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/media/audio.h"
#include "tools/speech/face_coding_internal.h"
#include "tools/speech/live_sound.h"

namespace animeme::speech {

namespace {

using media::LiveTrack;
using media::LiveUnit;

constexpr double kOpening = 0.1;    // seconds in which the mouth opens before sound that is late
constexpr double kLead = 0.5;       // seconds before its sound in which a piece bears on the mouth
constexpr float kAudible = 0.003F;  // of full scale
constexpr std::size_t kMostTraces = 1000;
constexpr std::size_t kMostOpen = 20;  // pieces in kLead
// Index of the first sample for which `heard` holds, the size if there is none.
template <class Heard>
std::int64_t first_sample(const std::vector<float>& samples, Heard heard) {
  return std::find_if(samples.begin(), samples.end(), heard) - samples.begin();
}

}  // namespace

struct LiveSpeaker::Impl {
  SpeakerOptions options;
  LineSource* lines;
  media::Clock* clock;
  TalkingFace face;
  std::optional<LiveSound> sound;
  fba::LiveEncoder encoder;
  media::LiveInfo info;
  std::int64_t frame_ticks = 1;

  struct Waiting {
    SpokenLine line;
    bool waited = false;                // LineTrace::waited
    std::optional<std::int64_t> start;  // sample where its sound has been laid
    std::int64_t sound_sign = 0;        // then
  };
  std::deque<Waiting> waiting;
  std::int64_t sound_end = 0;  // sample after the last line's sound
  std::deque<LineTrace> traces;
  // Where the first signs of a line are, face in ticks, sound in samples.
  struct Signs {
    std::int64_t face = 0, sound = 0;
  };
  std::deque<Signs> signs;  // of the traces
  std::vector<std::string> warnings;

  double frame_due() const { return double(face.number() * frame_ticks) / info.timescale; }
  double sound_due() const {
    if (!sound) return std::numeric_limits<double>::infinity();
    return double(sound->next_time()) / info.audio->sample_rate - options.audio_ahead;
  }
  // Instant before which sound has been made.
  double sound_made() const { return sound ? double(sound->made()) / options.voice_rate : 0; }

  void collect();
  void begin_lines();
  // Of the lines whose signs may still come: short pieces are begun before the last one is heard.
  template <class Look>
  void each_trace(Look look) {
    const std::size_t count = std::min<std::size_t>(traces.size(), kMostOpen);
    for (std::size_t i = traces.size() - count; i < traces.size(); ++i) look(traces[i], signs[i]);
  }
  Result<void> convert(media::Pcm& audio) const;
  std::int64_t lay(std::int64_t start, SpokenLine& line);
  std::int64_t place_after_the_last() const;
  bool has_to_wait(Waiting& next);
  Result<void> begin(Waiting& next, LineTrace& trace);
  Result<LiveUnit> make_plane();
  Result<LiveUnit> make_packet();
};

void LiveSpeaker::Impl::collect() {
  if (waiting.size() > 1) return;  // the source keeps what is not wanted yet
  for (SpokenLine& line : lines->take()) {
    const bool waited = !waiting.empty() || face.speaking();
    waiting.push_back({std::move(line), waited, std::nullopt});
  }
}

// Where a line goes that joins the one before: at its end, if that has not been made.
std::int64_t LiveSpeaker::Impl::place_after_the_last() const {
  const auto now = std::llround(frame_due() * options.voice_rate);
  const std::int64_t made = sound ? sound->made() : 0;
  if (sound_end >= std::max<std::int64_t>(made, now) && sound_end > 0) return sound_end;
  return std::max<std::int64_t>(made, now + std::llround(kOpening * options.voice_rate));
}

// Gives where its first sign will be.
std::int64_t LiveSpeaker::Impl::lay(std::int64_t start, SpokenLine& line) {
  std::vector<float>& samples = line.speech.audio.samples;
  const double seconds = line.speech.script.duration();
  const auto length = std::max<std::int64_t>(std::int64_t(samples.size()),
                                             std::llround(seconds * options.voice_rate));
  sound_end = start + length;
  if (!sound) return 0;
  const auto audible = first_sample(samples, [](float x) { return std::abs(x) >= kAudible; });
  sound->add(start, std::move(samples));
  return std::llround(double(start + audible) / options.voice_rate * info.audio->sample_rate);
}

Result<void> LiveSpeaker::Impl::convert(media::Pcm& audio) const {
  if (audio.sample_rate == options.voice_rate || audio.samples.empty()) return {};
  Result<media::Pcm> converted = media::resample(audio, options.voice_rate);
  if (!converted) return converted.error();
  audio = std::move(*converted);
  return {};
}

bool LiveSpeaker::Impl::has_to_wait(Waiting& next) {
  const media::Pcm& audio = next.line.speech.audio;
  if (!next.line.joins) {
    if (face.speaking()) return true;
    // Its first sound must not lie where the sound has been made already.
    const auto silence = first_sample(audio.samples, [](float x) { return x != 0; });
    return sound_made() - double(silence) / audio.sample_rate > frame_due();
  }
  // Its sound is laid in time. Its face is made with that of the piece before, shortly before that,
  // so that the mouth goes from one to the other as within a sentence.
  if (!next.start) {
    if (!convert(next.line.speech.audio)) return false;  // begin() says why
    next.start = place_after_the_last();
    next.sound_sign = lay(*next.start, next.line);
  }
  return face.speaking() && double(*next.start) / options.voice_rate >= frame_due() + kLead;
}

// A line that cannot be shown is left out; the next one may be shown.
void LiveSpeaker::Impl::begin_lines() {
  while (!waiting.empty() && !has_to_wait(waiting.front())) {
    const SpokenLine& line = waiting.front().line;
    LineTrace trace;
    trace.waited = waiting.front().waited;
    trace.arrived = line.arrived;
    trace.spoken = line.spoken;
    if (auto ok = begin(waiting.front(), trace); ok) {
      traces.push_back(trace);
      if (traces.size() > kMostTraces) {
        traces.pop_front();
        signs.pop_front();
      }
    } else {
      warnings.push_back("\"" + line.text.substr(0, 60) + "\" is left out: " + ok.error().message);
    }
    waiting.pop_front();
  }
}

Result<void> LiveSpeaker::Impl::begin(Waiting& next, LineTrace& trace) {
  trace.begun = clock->now();
  if (auto ok = convert(next.line.speech.audio); !ok) return ok;
  const dam::Script& script = next.line.speech.script;
  const double start = next.start ? double(*next.start) / options.voice_rate - frame_due() : 0;
  const Result<Line> shown =
      next.start ? face.join(script, std::max(start, 0.0)) : face.say(script);
  if (!shown) return shown.error();
  if (!next.start) {
    const double first = double(shown->first * frame_ticks) / info.timescale;
    next.sound_sign = lay(std::llround(first * options.voice_rate), next.line);
  }
  signs.push_back({shown->first_moved * frame_ticks, next.sound_sign});
  trace.synthesised = clock->now();
  return {};
}

Result<LiveUnit> LiveSpeaker::Impl::make_plane() {
  LiveUnit unit;
  unit.track = LiveTrack::face;
  unit.time = face.number() * frame_ticks;
  unit.duration = frame_ticks;
  const Result<fap::Frame> frame = face.next();
  if (!frame) return frame.error();
  const double begun = clock->now();
  Result<std::vector<std::uint8_t>> bytes = encoder.write(*frame);
  if (!bytes) return bytes.error();
  const double coded = clock->now();
  each_trace([&](LineTrace& trace, const Signs& sign) {
    if (unit.time != sign.face) return;
    trace.face_begun = begun;
    trace.face_coded = coded;
  });
  unit.bytes = std::move(*bytes);
  unit.intra = encoder.intra();
  return unit;
}

Result<LiveUnit> LiveSpeaker::Impl::make_packet() {
  const double begun = clock->now();
  Result<media::AudioPacket> packet = sound->next();
  if (!packet) return packet.error();
  LiveUnit unit{LiveTrack::audio, std::move(packet->bytes), false, packet->time, packet->duration};
  const double coded = clock->now();
  each_trace([&](LineTrace& trace, const Signs& sign) {
    if (unit.time + unit.duration <= sign.sound || trace.sound_coded != 0) return;
    trace.sound_begun = begun;
    trace.sound_coded = coded;
  });
  return unit;
}

LiveSpeaker::LiveSpeaker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LiveSpeaker::~LiveSpeaker() = default;

Result<std::unique_ptr<LiveSpeaker>> LiveSpeaker::open(const dam::Model& model, LineSource& lines,
                                                       media::Clock& clock,
                                                       const SpeakerOptions& options) {
  Result<TalkingFace> face = TalkingFace::open(model, options.face);
  if (!face) return face.error();
  std::optional<LiveSound> sound;
  if (options.audio) {
    Result<LiveSound> opened = LiveSound::open(options.voice_rate, *options.audio);
    if (!opened) return opened.error();
    sound = std::move(*opened);
  }
  const fba::LiveOptions live = coding_of_face(model, *face, options.face.synthesis.rate,
                                               options.fap_quant, options.intra_seconds);
  Result<FaceShape> shape = shape_of_face(live, *face);
  if (!shape) return shape.error();
  media::LiveInfo info = std::move(shape->info);
  if (sound) info.audio = sound->format();
  fba::LiveEncoder encoder(live);
  auto impl =
      std::make_unique<Impl>(Impl{options, &lines, &clock, std::move(*face), std::move(sound),
                                  std::move(encoder), std::move(info), shape->frame_ticks});
  return std::unique_ptr<LiveSpeaker>(new LiveSpeaker(std::move(impl)));
}

const media::LiveInfo& LiveSpeaker::info() const { return impl_->info; }
double LiveSpeaker::audio_ahead() const { return impl_->options.audio_ahead; }

std::optional<double> LiveSpeaker::next_due() {
  impl_->collect();
  if (silent() && impl_->lines->ended()) return std::nullopt;
  const double due = std::min(impl_->frame_due(), impl_->sound_due());
  if (due >= impl_->options.duration) return std::nullopt;
  return due;
}

Result<std::vector<LiveUnit>> LiveSpeaker::take(double now) {
  std::vector<LiveUnit> units;
  impl_->collect();
  for (;;) {
    const bool sound_first = impl_->sound_due() <= impl_->frame_due();
    if (std::min(impl_->sound_due(), impl_->frame_due()) > now) return units;
    if (!sound_first) impl_->begin_lines();
    Result<LiveUnit> unit = sound_first ? impl_->make_packet() : impl_->make_plane();
    if (!unit) return unit.error();
    units.push_back(std::move(*unit));
  }
}

void LiveSpeaker::sent(const LiveUnit& unit, double instant) {
  impl_->each_trace([&](LineTrace& trace, const Impl::Signs& sign) {
    if (unit.track == LiveTrack::face) {
      if (unit.time == sign.face && trace.face_coded > 0) trace.face_sent = instant;
    } else if (trace.sound_coded > 0 && trace.sound_sent == 0 &&
               unit.time + unit.duration > sign.sound) {
      trace.sound_sent = instant;
    }
  });
}

bool LiveSpeaker::silent() const { return impl_->waiting.empty() && !impl_->face.speaking(); }

const std::deque<LineTrace>& LiveSpeaker::traces() const { return impl_->traces; }

std::vector<std::string> LiveSpeaker::take_warnings() { return std::exchange(impl_->warnings, {}); }

}  // namespace animeme::speech
