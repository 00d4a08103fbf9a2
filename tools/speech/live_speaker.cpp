#include "tools/speech/live_speaker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/media/audio.h"
#include "tools/speech/face_coding_internal.h"
#include "tools/speech/live_sound.h"

namespace animeme::speech {

namespace {

using media::LiveTrack;
using media::LiveUnit;

constexpr float kAudible = 0.003F;  // of full scale
constexpr std::size_t kMostTraces = 1000;
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

  std::deque<std::pair<SpokenLine, bool>> waiting;  // with LineTrace::waited
  std::deque<LineTrace> traces;
  // Of the last trace: where its first signs are, face in ticks, sound in samples.
  std::int64_t face_sign = 0;
  std::int64_t sound_sign = 0;
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
  Result<void> begin(SpokenLine& line, LineTrace& trace);
  Result<LiveUnit> make_plane();
  Result<LiveUnit> make_packet();
};

void LiveSpeaker::Impl::collect() {
  if (waiting.size() > 1) return;  // the source keeps what is not wanted yet
  for (SpokenLine& line : lines->take()) {
    const bool waited = !waiting.empty() || face.speaking();
    waiting.emplace_back(std::move(line), waited);
  }
}

// A line that cannot be shown is left out; the next one may be shown.
void LiveSpeaker::Impl::begin_lines() {
  while (!waiting.empty() && !face.speaking()) {
    SpokenLine& line = waiting.front().first;
    // Its first sound must not lie where the sound has been made already.
    const media::Pcm& audio = line.speech.audio;
    const auto silence = first_sample(audio.samples, [](float x) { return x != 0; });
    if (sound_made() - double(silence) / audio.sample_rate > frame_due()) return;
    LineTrace trace;
    trace.waited = waiting.front().second;
    trace.arrived = line.arrived;
    trace.spoken = line.spoken;
    if (auto ok = begin(line, trace); ok) {
      traces.push_back(trace);
      if (traces.size() > kMostTraces) traces.pop_front();
    } else {
      warnings.push_back("\"" + line.text.substr(0, 60) + "\" is left out: " + ok.error().message);
    }
    waiting.pop_front();
  }
}

Result<void> LiveSpeaker::Impl::begin(SpokenLine& line, LineTrace& trace) {
  trace.begun = clock->now();
  const int rate = options.voice_rate;
  if (line.speech.audio.sample_rate != rate) {
    Result<media::Pcm> converted = media::resample(line.speech.audio, rate);
    if (!converted) return converted.error();
    line.speech.audio = std::move(*converted);
  }
  const Result<Line> shown = face.say(line.speech.script);
  if (!shown) return shown.error();
  face_sign = shown->first_moved * frame_ticks;
  if (sound) {
    const double first = double(shown->first * frame_ticks) / info.timescale;
    const std::int64_t start = std::llround(first * rate);
    const auto audible =
        first_sample(line.speech.audio.samples, [](float x) { return std::abs(x) >= kAudible; });
    sound->add(start, std::move(line.speech.audio.samples));
    sound_sign = std::llround(double(start + audible) / rate * info.audio->sample_rate);
  }
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
  if (!traces.empty() && unit.time == face_sign) {
    traces.back().face_begun = begun;
    traces.back().face_coded = clock->now();
  }
  unit.bytes = std::move(*bytes);
  unit.intra = encoder.intra();
  return unit;
}

Result<LiveUnit> LiveSpeaker::Impl::make_packet() {
  const double begun = clock->now();
  Result<media::AudioPacket> packet = sound->next();
  if (!packet) return packet.error();
  LiveUnit unit{LiveTrack::audio, std::move(packet->bytes), false, packet->time, packet->duration};
  if (!traces.empty() && unit.time + unit.duration > sound_sign && traces.back().sound_coded == 0) {
    traces.back().sound_begun = begun;
    traces.back().sound_coded = clock->now();
  }
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
  const bool silent = impl_->waiting.empty() && !impl_->face.speaking();
  if (silent && impl_->lines->ended()) return std::nullopt;
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
  if (impl_->traces.empty()) return;
  LineTrace& trace = impl_->traces.back();
  if (unit.track == LiveTrack::face) {
    if (unit.time == impl_->face_sign && trace.face_coded > 0) trace.face_sent = instant;
  } else if (trace.sound_coded > 0 && trace.sound_sent == 0 &&
             unit.time + unit.duration > impl_->sound_sign) {
    trace.sound_sent = instant;
  }
}

const std::deque<LineTrace>& LiveSpeaker::traces() const { return impl_->traces; }

std::vector<std::string> LiveSpeaker::take_warnings() { return std::exchange(impl_->warnings, {}); }

}  // namespace animeme::speech
