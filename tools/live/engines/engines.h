/// @file
/// Streaming faces to and from game engines and avatar programs: Live Link Face, VMC and VRChat's
/// OSC as live transports.
///
///     auto sink = engines::make_engine_sink("livelink://192.0.2.7:11111?subject=Anna");
///     (*sink)->start(info);
///     for (const LiveUnit& unit : units) (*sink)->send(unit);     // when it is due
///
///     auto source = engines::make_engine_source("livelink://:11111");   // a phone sends
///     while (auto event = (*source)->next(1.0)) ...                     // FBA access units
///
/// | address | protocol | read by |
/// |---|---|---|
/// | livelink://host:11111 | Live Link Face over UDP: 52 shapes of ARKit, head, eyes | Unreal |
/// | vmc://host:39539 | VMC over OSC: shapes by name; head and eyes as bones | VRM avatars |
/// | osc://host:9000 | Unified Expressions as parameters of an avatar | VRChat |
///
/// Options follow a question mark, joined by &:
///
/// | option | for | meaning |
/// |---|---|---|
/// | rate=15..120 | all | frames a second; sending: the stream's own, receiving: measured |
/// | subject=NAME | livelink | name of the face; receiving: accept only this. "Avatar" |
/// | timecode=day, stream | livelink, to send | frames from midnight, or from the begin: stream |
/// | names=arkit, vrm0, vrm1 | vmc, to send | JawOpen ..., A Blink_L Joy ..., aa blinkLeft ... |
/// | bones=on, off | vmc, to send | send head and eyes; on |
/// | prefix=NAME | osc, to send | before the name of a parameter; v2 |
/// | gaze=on, off | osc, to send | send /tracking/eye; on |
/// | binary=1..8 | osc, to send | also send so many bits of each parameter; none |
///
/// Weights are those of fap::ArkitFitter, faces those of fap::arkit_to_fap(). Sound is not sent.
/// Layouts are from public receivers and specifications, listed in the files of detail/.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"

namespace animeme::engines {

/// Is this an address of this folder (livelink://, vmc://, osc://)?
bool is_engine(std::string_view url);

/// Options for sending.
struct EngineSinkOptions {
  /// Send packets as soon as they are made; otherwise interpolated frames wait until they are due.
  bool fast = false;
  /// Receives each datagram and the presentation time of its frame instead of a socket (implies
  /// `fast`); empty: send to the address.
  std::function<void(double seconds, std::span<const std::uint8_t> datagram)> instead;
};

/// Options for receiving.
struct EngineSourceOptions {
  /// Treat datagrams of all addresses as one sender; otherwise see
  /// tools/formats/media/live/receiving.md, section 1.
  bool any_source = false;
  double intra_seconds = 1;  ///< seconds between intra planes of what is received, above 0
};

/// A sink that decodes units. Without rate= a frame is sent with its plane; with it frames are on a
/// regular grid, interpolated linearly, one plane later. Errors: invalid_argument (the address; an
/// unknown option or a value out of range, with a list of all options), io (host); start():
/// invalid_argument (no face), io.
Result<std::unique_ptr<media::LiveSink>> make_engine_sink(const std::string& url,
                                                          const EngineSinkOptions& options = {});

/// A source of planes on a regular grid: missing frames are interpolated for up to a second, longer
/// pauses are a LiveGap. Times are those of the sender if they advance in real time, else those of
/// arrival. Only VMC signals the end (/VMC/Ext/OK 0). Errors: invalid_argument (address), io (port
/// in use).
Result<std::unique_ptr<media::LiveSource>> make_engine_source(
    const std::string& url, const EngineSourceOptions& options = {});

}  // namespace animeme::engines
