// From transport packets to PES packets, with what is missing marked. Bytes are pushed as they
// come; nothing is looked ahead for, so a unit is there as soon as its last packet is.
// Source: tools/formats/media/containers.md, section 3.2; the syntax is that of ISO/IEC 13818-1.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "tools/formats/media/detail/ts/ts_sections.h"
#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// The content of a whole PES packet.
struct TsPes {
  LiveTrack track = LiveTrack::face;
  std::vector<std::uint8_t> bytes;
  std::optional<std::int64_t> stamp;  ///< presentation time, 90 kHz, 33 bits
  /// Packets of other PIDs got lost since the last one of this track. The counters have 4 bits, so
  /// 16 lost packets look like none.
  bool suspect = false;
  /// The tables came since the last one of this track.
  bool tables = false;
};

/// The program map came, or it changed.
struct TsMap {
  TsProgram program;
};

/// No program is left.
struct TsOver {};

using TsEvent = std::variant<TsPes, TsMap, LiveGap, TsOver>;

class TsDemuxer {
 public:
  /// Takes bytes in any cut and appends to `events`. Safe on anything.
  void push(std::span<const std::uint8_t> bytes, std::vector<TsEvent>& events);

  /// packets, bytes, lost, duplicates.
  const ReceiveStats& stats() const { return stats_; }

 private:
  struct Pid {
    int counter = -1;                            // of the last packet with payload
    std::array<std::uint8_t, kTsPacket> last{};  // to know a repeated packet by
  };
  struct Track {
    int pid = kTsNoPid;
    bool open = false;
    std::vector<std::uint8_t> bytes;  // from the start code on
    bool gap = false;
    std::int64_t lost = 0;  // packets, in front of the next unit
    bool suspect = false;
    bool tables = false;
  };
  struct Packet;

  void take_packet(std::span<const std::uint8_t> bytes, std::vector<TsEvent>& events);
  bool in_order(const Packet& packet);
  void missing(int pid, std::int64_t packets);
  void take_tables(const Packet& packet, std::vector<TsEvent>& events);
  void end(std::vector<TsEvent>& events);
  void adopt(const TsProgram& program, std::vector<TsEvent>& events);
  void take_payload(std::size_t track, const Packet& packet, std::vector<TsEvent>& events);
  void close(std::size_t track, std::vector<TsEvent>& events);
  void damage(Track& track);
  bool watched(int pid) const;

  std::vector<std::uint8_t> rest_;  // less than two packets, to find the beat
  std::map<int, Pid> pids_;         // PAT, maps, tracks
  TsSections pat_;
  std::map<int, TsSections> maps_;  // by PID
  std::optional<TsProgram> program_;
  std::array<Track, 2> tracks_;  // by LiveTrack
  ReceiveStats stats_;
};

}  // namespace animeme::media
