#include "tools/formats/media/detail/ts/ts_events.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/formats/media/detail/tracks/face_header.h"
#include "tools/formats/media/live/audio_segments.h"
#include "tools/formats/media/live/ts_live.h"

namespace animeme::media {
namespace {

constexpr std::int64_t kStampTurn = std::int64_t(1) << 33;
constexpr std::int64_t kPatience = 3 * 90000;  // ticks for which units wait for the description
constexpr std::size_t kMostHeld = 4096;
constexpr std::size_t kMostHeldBytes = std::size_t(4) << 20;
constexpr std::int64_t kTablesEvery = 45000;  // at least, by the standards that build on 13818-1
constexpr std::int64_t kOtherTrack = 22500;   // further than it ever is behind
constexpr int kLongestPriming = 4096;

std::int64_t to_samples(std::int64_t ticks, int rate) {
  const std::int64_t scaled = ticks * rate;
  return (scaled + (scaled < 0 ? -45000 : 45000)) / 90000;
}

}  // namespace

void TsEvents::push(TsEvent event, std::deque<LiveEvent>& out) {
  if (const auto* map = std::get_if<TsMap>(&event)) take_map(map->program);
  if (const auto* lost = std::get_if<LiveGap>(&event)) gap(lost->track, lost->packets);
  if (auto* pes = std::get_if<TsPes>(&event)) {
    pes->track == LiveTrack::face ? take_face(*pes) : take_sound(*pes);
  }
  if (std::holds_alternative<TsOver>(event)) return finish(out);
  const bool waited_enough =
      held_to_ - held_from_ > kPatience || held_.size() > kMostHeld || held_bytes_ > kMostHeldBytes;
  deliver(waited_enough, out);
}

void TsEvents::finish(std::deque<LiveEvent>& out) {
  deliver(true, out);
  out.emplace_back(LiveEnd{});
  *this = {};
}

void TsEvents::take_map(const TsProgram& program) {
  if (program.face != program_.face) {
    config_.clear();
    film_ = false;
    clocks_[0] = {};
  }
  if (program.sound != program_.sound || program.sound_codec != program_.sound_codec) {
    sound_ = TsSound(program.sound_codec, program.channels);
    clocks_[1] = {};
    priming_ = 0;
  }
  program_ = program;
}

void TsEvents::gap(LiveTrack track, std::int64_t packets) {
  if (track == LiveTrack::audio) sound_.reset();
  if (track == LiveTrack::face) cutter_.gap();
  held_.emplace_back(LiveGap{track, packets});
}

/// Stamps have 33 bits: the nearest one to what came before is meant.
std::optional<std::int64_t> TsEvents::unwrap(const TsPes& pes) {
  if (!pes.stamp) return {};
  std::int64_t stamp = *pes.stamp;
  if (last_stamp_) {
    const std::int64_t turns = *last_stamp_ - stamp + kStampTurn / 2;
    stamp += (turns >= 0 ? turns / kStampTurn : (turns + 1) / kStampTurn - 1) * kStampTurn;
  }
  last_stamp_ = stamp;
  return stamp;
}

/// Sixteen lost packets look like none to a counter of four bits. Are there other signs that
/// something is missing in front of this one? `interval`: between the two units before, in ticks.
bool TsEvents::outage(const TsPes& pes, std::int64_t stamp, std::int64_t interval) const {
  const auto& own = clocks_[std::size_t(pes.track)].stamp;
  const auto& other = clocks_[1 - std::size_t(pes.track)].stamp;
  if (!own || interval <= 0 || 2 * (stamp - *own) <= 3 * interval) return false;
  if (pes.suspect) return true;
  if (other && stamp - *other > kOtherTrack && *other >= *own - kOtherTrack) return true;
  return !pes.tables && stamp - *own > kTablesEvery;
}

void TsEvents::hold(LiveUnit unit, std::int64_t stamp) {
  if (held_.empty() || held_from_ == 0) held_from_ = held_to_ = stamp;
  held_to_ = std::max(held_to_, stamp);
  held_bytes_ += unit.bytes.size();
  held_.emplace_back(std::move(unit));
}

void TsEvents::take_face(TsPes& pes) {
  const VisualHeaders headers = read_visual_headers(pes.bytes);
  if (headers.kind == VisualKind::other) film_ = true;
  if (film_) return;
  const auto split = pes.bytes.begin() + std::ptrdiff_t(headers.size);
  LiveUnit unit{.track = LiveTrack::face, .bytes = {split, pes.bytes.end()}};
  const std::optional<bool> intra = read_is_intra(unit.bytes);
  if (!intra) {
    if (!unit.bytes.empty()) gap(LiveTrack::face, 0);
    return;
  }
  if (headers.kind == VisualKind::face) config_.assign(pes.bytes.begin(), split);
  if (config_.empty() && *intra) config_ = default_face_config();
  if (config_.empty()) return;  // a decoder cannot start here
  const auto stamp = unwrap(pes);
  Clock& clock = clocks_[0];
  const std::int64_t begin = stamp ? *stamp - kTsTimeZero : clock.last + clock.interval;
  if (stamp && outage(pes, *stamp, clock.interval)) gap(LiveTrack::face, 0);
  std::span<const std::uint8_t> rest(unit.bytes);
  for (const PlaneCutter::Piece& piece : cutter_.cut(rest, *intra)) {
    const std::int64_t later = std::llround(piece.seconds * 90000);
    LiveUnit plane{.track = LiveTrack::face,
                   .bytes = {rest.begin(), rest.begin() + std::ptrdiff_t(piece.size)},
                   .intra = read_is_intra(rest).value_or(false),
                   .time = begin + later};
    rest = rest.subspan(piece.size);
    if (stamp) clock.stamp = *stamp + later;
    if (clock.started && plane.time > clock.last) clock.interval = plane.time - clock.last;
    plane.duration = clock.interval;
    clock.last = plane.time;
    clock.started = true;
    hold(std::move(plane), clock.last + kTsTimeZero);
  }
}

void TsEvents::take_sound(TsPes& pes) {
  const auto stamp = unwrap(pes);
  const std::int64_t damaged = sound_.damaged();
  std::vector<AudioPacket> packets = sound_.push(pes.bytes);
  if (sound_.damaged() != damaged) gap(LiveTrack::audio, 0);
  if (packets.empty()) return;
  const int rate = sound_.format().sample_rate;
  Clock& clock = clocks_[1];
  const std::int64_t begin =
      stamp ? to_samples(*stamp - kTsTimeZero, rate) : clock.last + clock.interval;
  if (stamp && outage(pes, *stamp, clock.interval * 90000 / rate)) gap(LiveTrack::audio, 0);
  if (stamp) clock.stamp = stamp;
  for (AudioPacket& packet : packets) {
    LiveUnit unit{.track = LiveTrack::audio, .bytes = std::move(packet.bytes)};
    unit.time = begin + packet.time;
    unit.duration = packet.duration;
    if (!clock.started && unit.time < 0 && unit.time >= -kLongestPriming) {
      priming_ = int(-unit.time);
    }
    clock = {unit.time, unit.duration, true, clock.stamp};
    hold(std::move(unit), last_stamp_.value_or(0));
  }
}

bool TsEvents::known(LiveTrack track) const {
  if (track == LiveTrack::face) return program_.face == kTsNoPid || film_ || !config_.empty();
  return program_.sound == kTsNoPid || sound_.known();
}

LiveInfo TsEvents::describe() const {
  LiveInfo info{.face_config = config_, .timescale = 90000};
  if (!config_.empty()) {
    const std::uint8_t profile = read_visual_headers(config_).profile;
    if (profile != 0) info.visual_profile = profile;
  }
  if (sound_.known()) {
    info.audio = sound_.format();
    set_priming(*info.audio, priming_);
  }
  return info;
}

void TsEvents::deliver(bool whatever_is_known, std::deque<LiveEvent>& out) {
  const bool all_known = known(LiveTrack::face) && known(LiveTrack::audio);
  if (held_.empty() || (!all_known && !whatever_is_known && !told_)) return;
  LiveInfo info = describe();
  held_bytes_ = 0;
  if (info.face_config.empty() && !info.audio) return held_.clear();
  if (info != told_) {
    out.emplace_back(info);
    told_ = std::move(info);
  }
  for (LiveEvent& event : held_) out.push_back(std::move(event));
  held_.clear();
  held_from_ = 0;
}

}  // namespace animeme::media
