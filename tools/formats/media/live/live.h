/// @file
/// A face and its sound while they are being made: what all live transports have in common.
///
///     auto sink = open_sink("rtp://192.0.2.7:5004", {});
///     if (auto ok = (*sink)->start(info); !ok) return ok.error();
///     for (const LiveUnit& unit : units) (*sink)->send(unit);     // when it is due
///     (*sink)->finish();
///
///     auto source = open_source("talk.sdp", {});
///     while (auto event = (*source)->next(1.0)) { ... }
///
/// Sinks send at once what they are given; pacing is the caller's (see pacer.h). Sources give out
/// what came, with its losses marked; recovery.h decides what of it can be used.
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
  std::optional<AudioFormat> audio;       ///< nothing: silent

  friend bool operator==(const LiveInfo&, const LiveInfo&) = default;
};

/// The two media of a presentation.
enum class LiveTrack : std::uint8_t { face, audio };

/// One access unit of the face or one packet of sound.
struct LiveUnit {
  LiveTrack track = LiveTrack::face;  ///< whose unit
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
  std::int64_t receivers = 0;    ///< now connected (HTTP, SRT) or heard of (RTCP)
  std::int64_t dropped = 0;      ///< units that a slow receiver did not get
  double reported_loss = 0;      ///< share of packets, from receiver reports; 0..1
};

/// Sends one presentation. Not thread safe.
class LiveSink {
 public:
  virtual ~LiveSink() = default;
  /// Errors: invalid_argument, io (address, port in use), unsupported.
  virtual Result<void> start(const LiveInfo& info) = 0;
  /// Sends now. Does not wait for receivers. Errors: io, which for datagrams without a listener
  /// is no error.
  virtual Result<void> send(const LiveUnit& unit) = 0;
  /// Tells receivers what happens in the presentation, where the transport has a place for that: a
  /// JSON object on one line. Its member "time", if it has one, is in seconds, on the clock of
  /// LiveUnit::time. Errors: as send().
  virtual Result<void> tell(const std::string& json) {
    (void)json;
    return {};
  }
  /// Looks after connections and reports; to be called at least ten times a second.
  virtual Result<void> poll() = 0;
  /// Says goodbye and closes.
  virtual Result<void> finish() = 0;
  virtual SendStats stats() const = 0;  ///< since start()
};

/// Packets are missing before the next unit of this track.
struct LiveGap {
  LiveTrack track = LiveTrack::face;  ///< whose packets
  std::int64_t packets = 0;           ///< how many; 0: not known

  friend bool operator==(const LiveGap&, const LiveGap&) = default;
};

/// What follows is of another sender, or of the same one that has begun anew: its times have
/// nothing to do with those before, and its first planes may be predicted from others. LiveInfo
/// comes again.
struct LiveRestart {
  friend bool operator==(const LiveRestart&, const LiveRestart&) = default;
};

/// The sender has ended the presentation.
struct LiveEnd {
  friend bool operator==(const LiveEnd&, const LiveEnd&) = default;
};

/// Nothing came within the time given to next().
struct LiveIdle {
  friend bool operator==(const LiveIdle&, const LiveIdle&) = default;
};

/// Info comes first, and again if it changes.
using LiveEvent = std::variant<LiveInfo, LiveUnit, LiveGap, LiveRestart, LiveEnd, LiveIdle>;

/// Totals since the beginning.
struct ReceiveStats {
  std::int64_t packets = 0;     ///< that were read
  std::int64_t bytes = 0;       ///< of these
  std::int64_t lost = 0;        ///< packets that never came
  std::int64_t late = 0;        ///< came after they had been given up
  std::int64_t duplicates = 0;  ///< came again (repetition)
  std::int64_t reordered = 0;   ///< came behind a later one
  double jitter = 0;            ///< seconds, RFC 3550 section 6.4.1, of the face
  std::int64_t foreign = 0;     ///< datagrams of others than the sender, and damaged ones: ignored
  std::int64_t sessions = 0;    ///< senders, or begins of one
  double wait = 0;              ///< seconds that missing packets were waited for at most
  double latest = 0;            ///< seconds that a packet came behind one that was sent later

  /// Those of a sender and of the one after it: counts add up, the largest `latest` and the newest
  /// jitter and wait count.
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

/// Receives one presentation. Not thread safe. Safe for whatever comes over the network: memory
/// stays bounded, damaged packets are counted and dropped. Times are those of the sender, true or
/// not; session_clock.h has a clock that goes on when the sender begins anew.
class LiveSource {
 public:
  virtual ~LiveSource() = default;
  /// The next event, waiting at most `seconds`. Errors: io (the connection broke), syntax (not
  /// what this transport carries).
  virtual Result<LiveEvent> next(double seconds) = 0;
  virtual ReceiveStats stats() const = 0;  ///< since the beginning
};

}  // namespace animeme::media
