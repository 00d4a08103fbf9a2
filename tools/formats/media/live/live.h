/// @file
/// The common interface of all live transports of a face and its sound.
///
///     auto sink = open_sink("rtp://192.0.2.7:5004", {});
///     if (auto ok = (*sink)->start(info); !ok) return ok.error();
///     for (const LiveUnit& unit : units) (*sink)->send(unit);     // when it is due
///     (*sink)->finish();
///
///     auto source = open_source("talk.sdp", {});
///     while (auto event = (*source)->next(1.0)) { ... }
///
/// Sinks send units immediately; the caller paces them (see pacer.h). Sources return what was
/// received and report losses; recovery.h decides what can be used.
/// Source: tools/formats/media/containers.md, section 4.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"

namespace animeme::media {

/// Known before the first unit is sent.
struct LiveInfo {
  std::vector<std::uint8_t> face_config;  ///< as AccessUnits::config; empty: no face
  std::uint32_t timescale = 25000;        ///< of face times, ticks a second
  std::uint8_t visual_profile = 0x61;     ///< 0x61..0x64
  std::optional<AudioFormat> audio;       ///< nullopt: no sound

  friend bool operator==(const LiveInfo&, const LiveInfo&) = default;
};

/// The two media of a presentation.
enum class LiveTrack : std::uint8_t { face, audio };

/// One access unit of the face or one packet of sound.
struct LiveUnit {
  LiveTrack track = LiveTrack::face;  ///< track of the unit
  std::vector<std::uint8_t> bytes;    ///< access unit or packet
  bool intra = false;                 ///< face: a receiver can begin here
  /// Face: ticks of LiveInfo::timescale. Sound: samples. 0 is the same instant in both; the first
  /// packets of a sound have negative times (priming).
  std::int64_t time = 0;
  std::int64_t duration = 0;  ///< same ticks: how long it is shown or heard

  friend bool operator==(const LiveUnit&, const LiveUnit&) = default;
};

/// Totals since start().
struct SendStats {
  std::int64_t face_units = 0;   ///< access units
  std::int64_t audio_units = 0;  ///< packets of sound
  std::int64_t packets = 0;      ///< datagrams, messages or transport packets
  std::int64_t bytes = 0;        ///< on the wire, without the headers of UDP, TCP and IP
  std::int64_t repeated = 0;     ///< packets sent again by setting
  std::int64_t receivers = 0;    ///< currently connected (HTTP, SRT) or reporting (RTCP)
  std::int64_t dropped = 0;      ///< units dropped for slow receivers
  double reported_loss = 0;      ///< share of packets, from receiver reports; 0..1
  /// Share of the packets of sound, 0..1: of the receiver that reports most, of those that Opus'
  /// in-band FEC helps.
  double sound_loss = 0;
};

/// Sends one presentation. Not thread safe.
class LiveSink {
 public:
  virtual ~LiveSink() = default;
  /// Errors: invalid_argument, io (address, port in use), unsupported.
  virtual Result<void> start(const LiveInfo& info) = 0;
  /// Sends now, without waiting for receivers. Errors: io (datagrams without a receiver are not an
  /// error).
  virtual Result<void> send(const LiveUnit& unit) = 0;
  /// Sends an event of the presentation to receivers, if the transport supports it: a JSON object
  /// on one line. Its optional member "time" is in seconds, on the clock of LiveUnit::time. Errors:
  /// as send().
  virtual Result<void> tell(const std::string& json) {
    (void)json;
    return {};
  }
  /// Has a receiver asked for an intra plane since the last call? The next unit of the face should
  /// be one then; until the call after it the answer is no.
  virtual bool intra_wanted() { return false; }
  /// Maintains connections and sends reports; call it at least ten times a second.
  virtual Result<void> poll() = 0;
  /// Says goodbye and closes.
  virtual Result<void> finish() = 0;
  virtual SendStats stats() const = 0;  ///< since start()
};

/// Packets are missing before the next unit of this track.
struct LiveGap {
  LiveTrack track = LiveTrack::face;  ///< track of the packets
  std::int64_t packets = 0;           ///< number missing; 0: unknown

  friend bool operator==(const LiveGap&, const LiveGap&) = default;
};

/// What follows comes from another sender, or from a restarted one: its times are unrelated to the
/// previous ones, and its first planes may be predicted from planes that were not received.
/// LiveInfo is repeated.
struct LiveRestart {
  friend bool operator==(const LiveRestart&, const LiveRestart&) = default;
};

/// The sender has ended the presentation.
struct LiveEnd {
  friend bool operator==(const LiveEnd&, const LiveEnd&) = default;
};

/// Nothing arrived within the time given to next().
struct LiveIdle {
  friend bool operator==(const LiveIdle&, const LiveIdle&) = default;
};

/// Info comes first, and again if it changes.
using LiveEvent = std::variant<LiveInfo, LiveUnit, LiveGap, LiveRestart, LiveEnd, LiveIdle>;

/// Totals since the beginning.
struct ReceiveStats {
  std::int64_t packets = 0;     ///< received
  std::int64_t bytes = 0;       ///< of these
  std::int64_t lost = 0;        ///< packets that never arrived
  std::int64_t late = 0;        ///< arrived after they had been given up
  std::int64_t duplicates = 0;  ///< repeated packets
  std::int64_t reordered = 0;   ///< arrived after a later one
  double jitter = 0;            ///< seconds, RFC 3550 section 6.4.1, of the face
  std::int64_t foreign = 0;     ///< ignored datagrams: from other senders, or damaged
  std::int64_t sessions = 0;    ///< senders, counting restarts
  double wait = 0;              ///< longest wait for missing packets, seconds
  double latest = 0;            ///< largest delay of a packet after one sent later, seconds

  /// Adds the totals of a following sender: counts are summed; `latest` is the maximum, jitter and
  /// wait are the newer ones.
  ReceiveStats& operator+=(const ReceiveStats& next) {
    packets += next.packets;
    bytes += next.bytes;
    lost += next.lost;
    late += next.late;
    duplicates += next.duplicates;
    reordered += next.reordered;
    foreign += next.foreign;
    sessions += next.sessions;
    jitter = next.jitter;
    wait = next.wait;
    latest = std::max(latest, next.latest);
    return *this;
  }
};

/// Receives one presentation. Not thread safe. Safe for untrusted input: memory stays bounded,
/// damaged packets are counted and dropped. Times are those of the sender and not verified;
/// session_clock.h has a clock that continues when the sender restarts.
class LiveSource {
 public:
  virtual ~LiveSource() = default;
  /// The next event, waiting at most `seconds`. Errors: io (the connection broke), syntax (data of
  /// another protocol).
  virtual Result<LiveEvent> next(double seconds) = 0;
  virtual ReceiveStats stats() const = 0;  ///< since the beginning
};

}  // namespace animeme::media
