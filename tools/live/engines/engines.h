/// @file
/// Faces to and from engines and avatar programs: Live Link Face, VMC and VRChat's OSC as live
/// transports.
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
/// What follows a question mark, joined by &:
///
/// | member | for | meaning |
/// |---|---|---|
/// | rate=15..120 | all | frames a second; sending: the stream's own, receiving: measured |
/// | subject=NAME | livelink | whose face it is; receiving: hear nobody else. "Animeme" |
/// | names=arkit, vrm0, vrm1 | vmc, to send | JawOpen ..., A Blink_L Joy ..., aa blinkLeft ... |
/// | bones=on, off | vmc, to send | head and eyes go along; on |
/// | prefix=NAME | osc, to send | before the name of a parameter; v2 |
/// | gaze=on, off | osc, to send | /tracking/eye goes along; on |
///
/// Weights are those of fap::ArkitFitter, faces those of fap::arkit_to_fap(). Sound is not sent.
/// Layouts are from public receivers and specifications, which detail/ names file by file.
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

/// What sending takes beside the address.
struct EngineSinkOptions {
  /// Packets go out as soon as they are made; else frames between planes wait until they are due.
  bool fast = false;
  /// Gets each datagram and the presentation time of its frame in place of a socket (implies
  /// `fast`); empty: the address gets them.
  std::function<void(double seconds, std::span<const std::uint8_t> datagram)> instead;
};

/// What receiving takes beside the address.
struct EngineSourceOptions {
  /// Datagrams of all addresses are one sender's; else tools/formats/media/live/receiving.md,
  /// section 1.
  bool any_source = false;
  double intra_seconds = 1;  ///< seconds between intra planes of what is received, above 0
};

/// A sink that decodes what it is given. Without rate= a frame goes out with its plane; with it
/// frames lie on a grid of their own, between planes on straight lines, one plane later. Errors:
/// invalid_argument (the address; a member that is unknown or out of range, with all that there
/// are), io (host); start(): invalid_argument (no face), io.
Result<std::unique_ptr<media::LiveSink>> make_engine_sink(const std::string& url,
                                                          const EngineSinkOptions& options = {});

/// A source of planes on a regular grid: frames that are missing for up to a second lie between
/// their neighbours, longer pauses are a LiveGap. Times are those of the sender where they ascend
/// as time does, else those of arrival. VMC alone has an end (/VMC/Ext/OK 0). Errors:
/// invalid_argument (address), io (port in use).
Result<std::unique_ptr<media::LiveSource>> make_engine_source(
    const std::string& url, const EngineSourceOptions& options = {});

}  // namespace animeme::engines
