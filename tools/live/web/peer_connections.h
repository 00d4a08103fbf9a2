/// @file
/// The web server's interface to WebRTC: answers the offers that browsers post to `/whep`, and
/// sends to them. Implemented by tools/live/webrtc.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"

namespace animeme::web {

/// Answer to an offer.
struct PeerAnswer {
  unsigned status = 201;  ///< of HTTP
  std::string id;         ///< identifies the connection for end(); only for 201
  std::string text;       ///< the answer as a session description (201), else a sentence
};

/// WebRTC connections to browsers. Functions may be called from any thread; none blocks on a
/// browser.
class PeerConnections {
 public:
  virtual ~PeerConnections() = default;
  /// Call first, once; takes no time, and starts nothing that runs. At most `most` connections at a
  /// time, `per_address` of one address (0: any number). Errors: unsupported (with this sound, or
  /// on this machine).
  virtual Result<void> start(const media::LiveInfo& info, int most, int per_address) = 0;
  /// A page was opened, so that offers may come soon.
  virtual void expect() = 0;
  /// An offer from `address` (bytes of the socket address). `answer` is called once, possibly
  /// later, from any thread, but not after finish().
  virtual void offer(std::string sdp, std::string address,
                     std::function<void(PeerAnswer)> answer) = 0;
  /// Ends a connection. False: unknown id.
  virtual bool end(const std::string& id) = 0;
  /// A unit with the times given to LiveSink::send(). `values`: the message of `/faps`, empty for
  /// sound and for planes that could not be decoded.
  virtual void send(const media::LiveUnit& unit, std::string_view values) = 0;
  /// A message of LiveSink::tell(), with the times of `/faps`; it may get lost.
  virtual void tell(std::string_view json) { (void)json; }
  /// Closes all. `over`: viewers are told that the presentation is over; else they come back.
  virtual void finish(bool over) = 0;
  /// Connections, also those that are being made.
  virtual int busy() const = 0;
  /// `receivers`, `packets`, `bytes`, `dropped` and `repeated` of all connections, `reported_loss`
  /// (of the sound) and `sound_loss` of the one that has most.
  virtual media::SendStats stats() const = 0;
};

}  // namespace animeme::web
