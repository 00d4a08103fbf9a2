#include "tools/formats/media/live/presentation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/formats/media/detail/tracks/face_header.h"

namespace animeme::media {

namespace {

constexpr std::size_t kProfileByte = 4;  // of the configuration

void drop_object_start(std::vector<std::uint8_t>& bytes) {
  if (bytes.size() > kObjectStart.size() &&
      std::equal(kObjectStart.begin(), kObjectStart.end(), bytes.begin())) {
    bytes.erase(bytes.begin(), bytes.begin() + kObjectStart.size());
  }
}

std::int64_t up_to_multiple(double value, std::int64_t unit) {
  // Half a millionth of a tick is rounding, not length.
  return unit * std::int64_t(std::ceil(value / double(unit) - 1e-6));
}

}  // namespace

double seconds_of(const LiveInfo& info, LiveTrack track, std::int64_t time) {
  if (track == LiveTrack::face) return double(time) / double(info.timescale);
  return info.audio ? double(time) / double(info.audio->sample_rate) : 0;
}

double due_of(const LiveInput& input, const LiveUnit& unit) {
  const double seconds = seconds_of(input.info(), unit.track, unit.time) + input.delay();
  return unit.track == LiveTrack::audio ? seconds - input.audio_ahead() : seconds;
}

ClipInput::ClipInput(fba::AccessUnits face, EncodedAudio audio, const ClipOptions& options)
    : options_(options) {
  double face_end = 0, audio_end = 0;  // seconds
  std::int64_t grid = 1;
  if (!face.units.empty()) {
    info_.face_config = face.config;
    info_.timescale = face.timescale;
    if (face.config.size() > kProfileByte) info_.visual_profile = face.config[kProfileByte];
    const fba::AccessUnit& last = face.units.back();
    face_end = seconds_of(info_, LiveTrack::face, last.time + last.duration);
    grid = std::max<std::int64_t>(1, last.duration);
  }
  if (!audio.packets.empty()) {
    info_.audio = audio.format;
    if (face.units.empty()) info_.timescale = std::uint32_t(audio.format.sample_rate);
    const AudioPacket& last = audio.packets.back();
    audio_end =
        seconds_of(info_, LiveTrack::audio, last.time + last.duration + audio.format.priming);
  }
  round_ = std::max(grid, up_to_multiple(std::max(face_end, audio_end) * info_.timescale, grid));
  for (fba::AccessUnit& unit : face.units) {
    units_[0].push_back(
        {LiveTrack::face, std::move(unit.bytes), unit.intra, unit.time, unit.duration});
  }
  for (AudioPacket& packet : audio.packets) {
    units_[1].push_back(
        {LiveTrack::audio, std::move(packet.bytes), false, packet.time, packet.duration});
  }
}

std::int64_t ClipInput::shift(LiveTrack track, std::int64_t round) const {
  const std::int64_t ticks = round * round_;
  if (track == LiveTrack::face || !info_.audio) return ticks;
  const std::int64_t rate = info_.audio->sample_rate;
  const std::int64_t scale = info_.timescale;
  // In two parts, since the product of both could leave 64 bits after some months.
  return ticks / scale * rate + (ticks % scale * rate + scale / 2) / scale;
}

std::optional<double> ClipInput::due(LiveTrack track) const {
  const Cursor& at = at_[std::size_t(track)];
  const std::vector<LiveUnit>& units = units_[std::size_t(track)];
  if (at.unit >= units.size()) return std::nullopt;
  const double seconds = seconds_of(info_, track, units[at.unit].time + shift(track, at.round));
  if (seconds >= options_.duration) return std::nullopt;
  return track == LiveTrack::face ? seconds : seconds - options_.audio_ahead;
}

LiveUnit ClipInput::current(LiveTrack track) const {
  const Cursor& at = at_[std::size_t(track)];
  LiveUnit out = units_[std::size_t(track)][at.unit];
  if (track == LiveTrack::face && at.round > 0) drop_object_start(out.bytes);
  out.time += shift(track, at.round);
  return out;
}

void ClipInput::advance(LiveTrack track) {
  Cursor& at = at_[std::size_t(track)];
  if (++at.unit < units_[std::size_t(track)].size() || !options_.loop) return;
  at.unit = 0;
  ++at.round;
}

std::optional<double> ClipInput::next_due() {
  const std::optional<double> face = due(LiveTrack::face);
  const std::optional<double> audio = due(LiveTrack::audio);
  if (!face) return audio;
  return audio ? std::min(*face, *audio) : *face;
}

Result<std::vector<LiveUnit>> ClipInput::take(double now) {
  std::vector<LiveUnit> units;
  for (;;) {
    const std::optional<double> face = due(LiveTrack::face);
    const std::optional<double> audio = due(LiveTrack::audio);
    const bool sound_first = audio && (!face || *audio <= *face);
    const LiveTrack track = sound_first ? LiveTrack::audio : LiveTrack::face;
    const std::optional<double>& first = sound_first ? audio : face;
    if (!first || *first > now) return units;
    units.push_back(current(track));
    advance(track);
  }
}

}  // namespace animeme::media
