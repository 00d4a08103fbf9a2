/// @file
/// A face and its sound as an MPEG transport stream over UDP or SRT.
///
///     auto sink = make_ts_sink("udp://239.1.2.3:5004?ttl=4");
///     auto source = make_ts_source("srt://192.0.2.7:5005?mode=caller&latency=200000");
///
/// Addresses: udp://HOST:PORT, unicast or multicast, and srt://HOST:PORT?mode=caller (the default)
/// or listener. Further options behind the question mark go to FFmpeg's protocol (udp: ttl,
/// localaddr, buffer_size ...; srt: latency in microseconds, passphrase, streamid ...); FFmpeg
/// ignores options that it does not know. (For a UDP source only sources, block, localport,
/// connect, reuse and timeout go there; FFmpeg then does not report the sender, so all senders are
/// accepted.) A UDP source binds to HOST if that is an address of this machine or a multicast
/// group; udp://0.0.0.0:PORT and udp://:PORT bind to all addresses.
///
/// On the wire: stream type 0x10 with the configuration before each intra plane, AAC as ADTS (0x0F)
/// or Opus (0x06). Each unit is one PES packet, sent immediately and with its length, so that a
/// receiver need not wait for the next one. PAT and PMT are repeated for receivers that join late.
/// Time 0 has the timestamp kTsTimeZero. finish() sends a PAT without programs, which our source
/// treats as the end.
///
/// Received units are byte for byte those sent. Face times are 90 kHz timestamps; sound times are
/// samples, rounded from these. LiveInfo::timescale is 90000. AudioFormat comes from the stream:
/// `config` is equivalent to the sender's, except that AAC may lose the extension of its 5-byte
/// form and Opus its gain; `priming` is that of the sender if the first packet was received, else
/// 0.
/// Source: tools/formats/media/containers.md, sections 3.2, 4.2 and 5.2.
#pragma once

#include <memory>
#include <string>

#include "tools/formats/media/live/live.h"

namespace animeme::media {

/// Timestamp (90 kHz) of time 0: one second, so that the priming of the sound has valid timestamps.
inline constexpr std::int64_t kTsTimeZero = 90000;

/// For both directions.
struct TsOptions {
  /// Payload of a datagram or SRT message at most, rounded down to whole packets of 188 bytes;
  /// 188..1456. Smaller ones are sent as soon as a unit is complete.
  int datagram_bytes = 1316;
  double table_period = 0.25;  ///< seconds between PAT and PMT, 0.02..0.5
  /// Sink: bytes queued for a slow network before units are dropped.
  /// Source: bytes queued for next().
  std::size_t queue_bytes = std::size_t(4) << 20;
  /// Source, udp: true merges datagrams of all addresses into one stream. False accepts the first
  /// address that sends a program, and another one when it has been silent for a second
  /// (LiveRestart).
  bool any_source = false;
};

/// Sends to `url`. Nothing is opened before start(). An SRT listener waits in the background for a
/// receiver, and for the next one after it disconnects; units sent meanwhile are lost
/// (SendStats::dropped).
/// Errors: invalid_argument (address, options), unsupported (this FFmpeg lacks the protocol).
/// Errors of start(): io (no listener, no route), invalid_argument (nothing to send, a
/// configuration that is not of a face), unsupported (sound that TS cannot carry).
Result<std::unique_ptr<LiveSink>> make_ts_sink(const std::string& url,
                                               const TsOptions& options = {});

/// Starts receiving from `url`. A thread reads the network, at most `queue_bytes` ahead. The end of
/// an SRT connection is LiveEnd. Lost packets are detected by the continuity counters of the two
/// tracks: damaged units are dropped, with a LiveGap before the next one. LiveInfo waits for the
/// configuration of the face and the first packet of the sound, for at most 3 seconds of stream; if
/// the other arrives later, there is a second LiveInfo. Data that is not a transport stream is
/// ignored, but over SRT, which has only one sender, it is an error (syntax).
/// Errors: invalid_argument, unsupported as above; io (port in use, no such group, no listener). A
/// source in mode=listener returns at once and waits in next().
Result<std::unique_ptr<LiveSource>> make_ts_source(const std::string& url,
                                                   const TsOptions& options = {});

}  // namespace animeme::media
