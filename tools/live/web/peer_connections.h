/// @file
/// WebRTC of the web server: who answers the offers that browsers post to `/whep`, and sends to
/// them. tools/live/webrtc has one; the server knows of WebRTC no more than this.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"

namespace animeme::web {

/// What becomes of an offer.
struct PeerAnswer {
  unsigned status = 201;  ///< of HTTP
  std::string id;         ///< by which the connection is ended; 201 alone
  std::string text;       ///< the answer as a session description (201), else a sentence
};

/// Connections to browsers by WebRTC. Functions may be called from any thread; none waits for a
/// browser.
class PeerConnections {
 public:
  virtual ~PeerConnections() = default;
  /// Before all others, once. `most` connections at the same time, `per_address` of one address
  /// (0: any number). Errors: unsupported (not with this sound, or not on this machine).
  virtual Result<void> start(const media::LiveInfo& info, int most, int per_address) = 0;
  /// Offers may come soon: somebody looks at the page.
  virtual void expect() = 0;
  /// Somebody at `address` (bytes, as of the socket) wants to watch. `answer` is called once,
  /// sooner or later, from any thread, but not after finish().
  virtual void offer(std::string sdp, std::string address,
                     std::function<void(PeerAnswer)> answer) = 0;
  /// The viewer has gone. False: there is none with this id.
  virtual bool end(const std::string& id) = 0;
  /// A unit with the times given to LiveSink::send(). `values`: the message of `/faps`, empty for
  /// sound and for planes that could not be decoded.
  virtual void send(const media::LiveUnit& unit, std::string_view values) = 0;
  /// A message of LiveSink::tell(), with the times that `/faps` has; it may be lost on the way.
  virtual void tell(std::string_view json) { (void)json; }
  /// Says goodbye to all and closes.
  virtual void finish() = 0;
  /// `receivers`, `packets`, `bytes`, `dropped` and `repeated` of all connections.
  virtual media::SendStats stats() const = 0;
};

}  // namespace animeme::web
