#include "tools/formats/media/detail/ts/ts_demuxer.h"

#include <algorithm>

namespace animeme::media {
namespace {

constexpr std::size_t kMostMaps = 16;
constexpr std::size_t kLargestPes = std::size_t(1) << 20;
constexpr std::size_t kPesStart = 6;  // start code, stream, length

/// Bytes that the PES packet says it has; nullopt: it does not say, or not yet.
std::optional<std::size_t> stated_size(std::span<const std::uint8_t> pes) {
  if (pes.size() < kPesStart) return {};
  const std::size_t length = std::size_t(pes[4]) << 8 | pes[5];
  if (length == 0) return {};
  return kPesStart + length;
}

std::int64_t read_stamp(std::span<const std::uint8_t> bytes) {
  return std::int64_t(bytes[0] >> 1 & 7) << 30 | std::int64_t(bytes[1]) << 22 |
         std::int64_t(bytes[2] >> 1) << 15 | std::int64_t(bytes[3]) << 7 | bytes[4] >> 1;
}

}  // namespace

struct TsDemuxer::Packet {
  std::span<const std::uint8_t> bytes;
  int pid = 0;
  int counter = 0;
  bool begins = false;         // a PES packet or section
  bool discontinuity = false;  // the counter may jump
  std::span<const std::uint8_t> payload;
};

void TsDemuxer::push(std::span<const std::uint8_t> bytes, std::vector<TsEvent>& events) {
  stats_.bytes += std::int64_t(bytes.size());
  rest_.insert(rest_.end(), bytes.begin(), bytes.end());
  std::size_t at = 0;
  while (rest_.size() - at >= kTsPacket) {
    // Out of step: a sync byte with another one a packet later is the beat again.
    const bool beat = rest_[at] == kTsSync &&
                      (rest_.size() - at <= kTsPacket || rest_[at + kTsPacket] == kTsSync);
    if (beat) take_packet(std::span(rest_).subspan(at, kTsPacket), events);
    at += beat ? kTsPacket : 1;
  }
  rest_.erase(rest_.begin(), rest_.begin() + std::ptrdiff_t(at));
}

bool TsDemuxer::watched(int pid) const {
  return pid == 0 || maps_.contains(pid) || (pid != kTsNoPid && pid == tracks_[0].pid) ||
         (pid != kTsNoPid && pid == tracks_[1].pid);
}

void TsDemuxer::take_packet(std::span<const std::uint8_t> bytes, std::vector<TsEvent>& events) {
  ++stats_.packets;
  const bool damaged = (bytes[1] & 0x80) != 0, scrambled = (bytes[3] & 0xC0) != 0;
  Packet packet{.bytes = bytes, .pid = (bytes[1] & 0x1F) << 8 | bytes[2]};
  if (damaged || scrambled || !watched(packet.pid)) return;
  packet.counter = bytes[3] & 15;
  packet.begins = (bytes[1] & 0x40) != 0;
  std::size_t at = 4;
  if ((bytes[3] & 0x20) != 0) {
    packet.discontinuity = bytes[4] > 0 && (bytes[5] & 0x80) != 0;
    at += 1 + std::size_t(bytes[4]);
  }
  if ((bytes[3] & 0x10) == 0 || at >= kTsPacket) return;  // the counter stands still
  packet.payload = bytes.subspan(at);
  if (!in_order(packet)) return;
  if (packet.pid == tracks_[0].pid) return take_payload(0, packet, events);
  if (packet.pid == tracks_[1].pid) return take_payload(1, packet, events);
  take_tables(packet, events);
}

bool TsDemuxer::in_order(const Packet& packet) {
  Pid& pid = pids_[packet.pid];
  const int before = pid.counter;
  if (before == packet.counter && !packet.discontinuity &&
      std::equal(pid.last.begin(), pid.last.end(), packet.bytes.begin())) {
    ++stats_.duplicates;
    return false;
  }
  pid.counter = packet.counter;
  std::copy(packet.bytes.begin(), packet.bytes.end(), pid.last.begin());
  if (before < 0 || packet.counter == (before + 1) % 16) return true;
  missing(packet.pid, packet.discontinuity ? 0 : (packet.counter - before + 15) % 16);
  return true;
}

void TsDemuxer::missing(int pid, std::int64_t packets) {
  stats_.lost += packets;
  if (pid == 0) pat_.reset();
  if (const auto map = maps_.find(pid); map != maps_.end()) map->second.reset();
  for (Track& track : tracks_) {
    track.suspect = true;
    if (track.pid != pid) continue;
    track.lost += packets;
    damage(track);
  }
}

void TsDemuxer::damage(Track& track) {
  track.open = false;
  track.gap = true;
  track.bytes.clear();
}

void TsDemuxer::take_tables(const Packet& packet, std::vector<TsEvent>& events) {
  if (packet.pid != 0) {
    for (const auto& section : maps_[packet.pid].push(packet.payload, packet.begins)) {
      if (const auto program = read_pmt(section)) adopt(*program, events);
    }
    return;
  }
  for (Track& track : tracks_) track.tables = true;
  for (const auto& section : pat_.push(packet.payload, packet.begins)) {
    const auto pids = read_pat(section);
    if (!pids) continue;
    if (pids->empty()) {
      end(events);
      return;
    }
    for (const int pid : *pids) {
      if (maps_.size() < kMostMaps) maps_.try_emplace(pid);
    }
  }
}

void TsDemuxer::end(std::vector<TsEvent>& events) {
  if (program_) events.emplace_back(TsOver{});
  program_.reset();
  tracks_ = {};
  maps_.clear();
  pids_.clear();  // the next sender has its own continuity counters
}

void TsDemuxer::adopt(const TsProgram& program, std::vector<TsEvent>& events) {
  if (program.face == kTsNoPid && program.sound == kTsNoPid) return;
  // One with a face is better than one without.
  if (program_ &&
      (*program_ == program || (program_->face != kTsNoPid && program.face == kTsNoPid))) {
    return;
  }
  program_ = program;
  for (const std::size_t track : {0u, 1u}) {
    const int pid = track == 0 ? program.face : program.sound;
    if (pid == tracks_[track].pid) continue;
    pids_.erase(tracks_[track].pid);
    tracks_[track] = {.pid = pid};
  }
  events.emplace_back(TsMap{program});
}

void TsDemuxer::take_payload(std::size_t index, const Packet& packet,
                             std::vector<TsEvent>& events) {
  Track& track = tracks_[index];
  if (packet.begins) {
    // A packet without a length ends where the next one begins.
    if (track.open && !stated_size(track.bytes)) close(index, events);
    if (track.open) damage(track);
    track.open = true;
    track.bytes.clear();
  }
  if (!track.open) return;
  track.bytes.insert(track.bytes.end(), packet.payload.begin(), packet.payload.end());
  const auto size = stated_size(track.bytes);
  if (size && track.bytes.size() >= *size) {
    track.bytes.resize(*size);
    close(index, events);
  } else if (track.bytes.size() > kLargestPes) {
    damage(track);
  }
}

void TsDemuxer::close(std::size_t index, std::vector<TsEvent>& events) {
  Track& track = tracks_[index];
  const std::span<const std::uint8_t> pes(track.bytes);
  const bool sound = pes.size() >= 9 && pes[0] == 0 && pes[1] == 0 && pes[2] == 1 &&
                     (pes[6] & 0xC0) == 0x80 && pes.size() >= 9 + std::size_t(pes[8]);
  if (!sound) return damage(track);
  const LiveTrack name = LiveTrack(index);
  if (track.gap) events.emplace_back(LiveGap{name, track.lost});
  TsPes unit{.track = name, .suspect = track.suspect && !track.gap, .tables = track.tables};
  if ((pes[7] & 0x80) != 0 && pes[8] >= 5) unit.stamp = read_stamp(pes.subspan(9, 5));
  const auto content = pes.subspan(9 + std::size_t(pes[8]));
  unit.bytes.assign(content.begin(), content.end());
  events.emplace_back(std::move(unit));
  track.open = track.gap = track.suspect = track.tables = false;
  track.lost = 0;
}

}  // namespace animeme::media
