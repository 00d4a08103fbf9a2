#include "tools/speech/talking/live_speaker.h"

#include <algorithm>
#include <utility>

#include "tools/speech/talking/face_coding_internal.h"
#include "tools/speech/talking/live_speaker_internal.h"

namespace animeme::speech {

namespace {

using media::LiveTrack;
using media::LiveUnit;

}  // namespace

void LiveSpeaker::Impl::listen() {
  if (!other) return;
  face.hear(other->at(frame_due()));
  if (const auto error = other->take_error())
    warnings.push_back("the sound of --hear has ended: " + error->describe());
}

Result<LiveUnit> LiveSpeaker::Impl::make_plane() {
  LiveUnit unit;
  unit.track = LiveTrack::face;
  unit.time = face.number() * frame_ticks;
  unit.duration = frame_ticks;
  const bool speaking = face.speaking();
  listen();
  const Result<fap::Frame> frame = face.next();
  if (!frame) return frame.error();
  if (speaking && !face.speaking()) {
    silent_since = clock->now();
    face_rests = frame_due();
  }
  const double begun = clock->now();
  Result<std::vector<std::uint8_t>> bytes = encoder.write(*frame);
  if (!bytes) return bytes.error();
  unit.time -= std::int64_t(encoder.held()) * frame_ticks;
  traces.coded(unit, begun, clock->now());
  unit.bytes = std::move(*bytes);
  unit.intra = encoder.intra();
  return unit;
}

Result<LiveUnit> LiveSpeaker::Impl::make_packet() {
  const double begun = clock->now();
  Result<media::AudioPacket> packet = sound->next();
  if (!packet) return packet.error();
  LiveUnit unit{LiveTrack::audio, std::move(packet->bytes), false, packet->time, packet->duration};
  traces.coded(unit, begun, clock->now());
  return unit;
}

LiveSpeaker::LiveSpeaker(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LiveSpeaker::~LiveSpeaker() = default;

Result<std::unique_ptr<LiveSpeaker>> LiveSpeaker::open(const dam::Model& model, LineSource& lines,
                                                       media::Clock& clock,
                                                       const SpeakerOptions& options) {
  FaceOptions moving = options.face;
  // Without quantisation, angles end at one degree.
  if (options.fap_quant == 0) moving.idle.still.gaze = moving.idle.still.head = true;
  Result<TalkingFace> face = TalkingFace::open(model, moving);
  if (!face) return face.error();
  std::optional<LiveSound> sound;
  if (options.audio) {
    Result<LiveSound> opened = LiveSound::open(options.voice_rate, *options.audio);
    if (!opened) return opened.error();
    sound = std::move(*opened);
  }
  const fba::LiveOptions live =
      coding_of_face(model, *face, options.face.synthesis.rate, options.fap_quant,
                     options.intra_seconds, options.coding_delay);
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
double LiveSpeaker::delay() const { return impl_->options.coding_delay; }

std::optional<double> LiveSpeaker::next_due() {
  if (silent() && impl_->lines->ended()) return std::nullopt;
  const double due =
      std::min({impl_->frame_due(), impl_->sound_due(), impl_->waiting_sound.next_due()});
  if (due >= impl_->options.duration + impl_->options.coding_delay) return std::nullopt;
  return due;
}

Result<std::vector<LiveUnit>> LiveSpeaker::take(double now) {
  std::vector<LiveUnit> units;
  impl_->collect(now);
  for (;;) {
    const bool sound_first = impl_->sound_due() <= impl_->frame_due();
    const double due = std::min(impl_->sound_due(), impl_->frame_due());
    impl_->waiting_sound.release(std::min(due, now), units);
    if (due > now) return units;
    if (!sound_first) impl_->begin_lines(now);
    Result<LiveUnit> unit = sound_first ? impl_->make_packet() : impl_->make_plane();
    if (!unit) return unit.error();
    if (sound_first && impl_->options.coding_delay > 0) {
      impl_->waiting_sound.add(std::move(*unit), due + impl_->options.coding_delay);
    } else if (!unit->bytes.empty()) {
      units.push_back(std::move(*unit));
    }
  }
}

void LiveSpeaker::sent(const LiveUnit& unit, double instant) {
  impl_->traces.sent(unit, instant);
  if (unit.track == LiveTrack::face) {
    impl_->events.tell(media::seconds_of(impl_->info, unit.track, unit.time));
    if (!impl_->options.events) impl_->events.take();
  }
}

bool LiveSpeaker::silent() const {
  const double sound_end = double(impl_->sound_end) / impl_->options.voice_rate;
  const double end = std::max({impl_->settled, sound_end, impl_->face_rests});
  const bool settled = impl_->frame_due() >= end + impl_->options.coding_delay;
  return !impl_->waiting && !impl_->held && !impl_->face.speaking() && settled;
}

void LiveSpeaker::hear(std::unique_ptr<OtherVoice> other) { impl_->other = std::move(other); }

void LiveSpeaker::expect_loss(int percent) {
  if (impl_->sound) impl_->sound->expect_loss(percent);
}

std::vector<LineEvent> LiveSpeaker::take_events() { return impl_->events.take(); }

void LiveSpeaker::end(const std::string& why) {
  const double time = impl_->frame_due();
  impl_->lines->abandon(why);
  impl_->collect(time);
  impl_->paused = false;
  impl_->held.reset();
  if (impl_->waiting) impl_->cancel(impl_->waiting->line, why);
  impl_->waiting.reset();
  impl_->events.cut(time, std::numeric_limits<std::uint64_t>::max(), why);
  impl_->events.tell(time);
}

const std::deque<LineTrace>& LiveSpeaker::traces() const { return impl_->traces.all(); }

std::vector<std::string> LiveSpeaker::take_warnings() { return std::exchange(impl_->warnings, {}); }

}  // namespace animeme::speech
