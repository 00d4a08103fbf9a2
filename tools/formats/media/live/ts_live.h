/// @file
/// A face and its sound as an MPEG transport stream over UDP or SRT.
///
///     auto sink = make_ts_sink("udp://239.1.2.3:5004?ttl=4");
///     auto source = make_ts_source("srt://192.0.2.7:5005?mode=caller&latency=200000");
///
/// Addresses: udp://HOST:PORT, unicast or multicast, and srt://HOST:PORT?mode=caller (the default)
/// or listener. Further options behind the question mark go to FFmpeg's protocol (udp: ttl,
/// localaddr, buffer_size ...; srt: latency in microseconds, passphrase, streamid ...); one that
/// it does not know is ignored by FFmpeg. (Of a UDP source only sources, block, localport, connect,
/// reuse and timeout go there; FFmpeg does not tell then who sends, so that all are heard.) A UDP
/// source binds to HOST where that is an address of this machine or a multicast group;
/// udp://0.0.0.0:PORT and udp://:PORT take all.
///
/// On the wire: stream type 0x10 with the configuration in front of each intra plane, AAC as ADTS
/// (0x0F) or Opus (0x06). One PES packet for each unit, sent at once, with its length, so that
/// nobody has to wait for the next one. PAT and PMT are repeated for those who join late. Time 0
/// has the stamp kTsTimeZero. finish() sends a PAT without programs, which our source takes as the
/// end.
///
/// What comes back: units byte for byte. Face times are stamps of 90 kHz, sound times samples,
/// rounded from those. LiveInfo::timescale is 90000. AudioFormat is what the stream tells: `config`
/// has the same meaning as the sender's, but AAC may have lost an extension of its 5-byte form and
/// Opus its gain; `priming` is that of the sender where the first packet is at hand, else 0.
/// Source: tools/formats/media/containers.md, sections 3.2, 4.2 and 5.2.
#pragma once

#include <memory>
#include <string>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// Stamp (90 kHz) of time 0: one second, so that the priming of the sound has stamps, too.
inline constexpr std::int64_t kTsTimeZero = 90000;

/// For both directions.
struct TsOptions {
  /// Payload of a datagram or SRT message at most, rounded down to whole packets of 188 bytes;
  /// 188..1456. Smaller ones are sent as soon as a unit is complete.
  int datagram_bytes = 1316;
  double table_period = 0.25;  ///< seconds between PAT and PMT, 0.02..0.5
  /// Sink: bytes that may wait for a slow network before units are dropped.
  /// Source: bytes that may wait for next().
  std::size_t queue_bytes = std::size_t(4) << 20;
  /// Source, udp: datagrams of all addresses are one stream. Else the first address that sends a
  /// program is heard, and another one when that is silent for a second (LiveRestart).
  bool any_source = false;
};

/// Sends to `url`. Nothing is opened before start(). An SRT listener waits for its receiver in the
/// background and for the next one when that has gone; units sent meanwhile are lost
/// (SendStats::dropped).
/// Errors: invalid_argument (address, options), unsupported (this FFmpeg lacks the protocol).
/// Those of start(): io (nobody listens, no route), invalid_argument (nothing to send, a
/// configuration that is not of a face), unsupported (sound that TS cannot carry).
Result<std::unique_ptr<LiveSink>> make_ts_sink(const std::string& url,
                                               const TsOptions& options = {});

/// Receives from `url` from now on. A thread reads the network, at most `queue_bytes` ahead.
/// The end of an SRT connection is LiveEnd. Packets that never came are counted by the continuity
/// counters of the two tracks: units that they damage are left out, with a LiveGap in front of the
/// next one. LiveInfo waits for the configuration of the face and the first packet of the sound,
/// for 3 seconds of stream at most; what comes later brings a second LiveInfo. What is no transport
/// stream is passed over; over SRT, where nobody else can come, it is an error (syntax).
/// Errors: invalid_argument, unsupported as above; io (port in use, no such group, nobody listens).
/// A source in mode=listener returns at once and waits in next().
Result<std::unique_ptr<LiveSource>> make_ts_source(const std::string& url,
                                                   const TsOptions& options = {});

}  // namespace animeme::media
